#include "fem/beam_properties.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::fem {

namespace {

[[noreturn]] void reject(const char* function, const char* member, double value, const char* expected) {
  throw std::invalid_argument(fmt::format("{}: {} is {}, expected {}", function, member, value, expected));
}

}  // namespace

void check_beam_properties(const BeamProperties& properties, const char* function) {
  const auto& [EA, EI, kGA, rho_A, rho_I, A, W, bushing] = properties;
  if (!(EA > 0.0) || std::isinf(EA)) reject(function, "axial_rigidity", EA, "a finite value > 0 N");
  if (!(EI > 0.0) || std::isinf(EI)) reject(function, "bending_rigidity", EI, "a finite value > 0 N·m²");
  if (!(kGA > 0.0)) reject(function, "shear_rigidity", kGA, "a value > 0 N or infinity");
  if (!(rho_A >= 0.0) || std::isinf(rho_A))
    reject(function, "mass_per_length", rho_A, "a finite value ≥ 0 kg/m");
  if (!(rho_I >= 0.0) || std::isinf(rho_I))
    reject(function, "rotary_inertia", rho_I, "a finite value ≥ 0 kg·m");
  if (!(A >= 0.0) || std::isinf(A)) reject(function, "area", A, "a finite value ≥ 0 m²");
  if (!(W >= 0.0) || std::isinf(W)) reject(function, "section_modulus", W, "a finite value ≥ 0 m³");
}

}  // namespace sprung::fem
