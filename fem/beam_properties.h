#pragma once

#include <limits>
#include <optional>

#include "fem/bushing.h"

namespace sprung::fem {

/// Properties of a beam element's cross section. Parallel members are included.
struct BeamProperties {
  double axial_rigidity = 0.0;    ///< EA > 0 [N]
  double bending_rigidity = 0.0;  ///< EI > 0 [N·m²]
  /// κGA > 0 [N]; infinity: no shear deformation (Euler–Bernoulli)
  double shear_rigidity = std::numeric_limits<double>::infinity();
  double mass_per_length = 0.0;  ///< ρA ≥ 0 [kg/m]
  double rotary_inertia = 0.0;   ///< ρI ≥ 0 of the section's rotation, per length [kg·m]; 0: neglected
  // Only stresses need these.
  double area = 0.0;             ///< A ≥ 0 [m²]; 0: not known
  double section_modulus = 0.0;  ///< W ≥ 0 of the extreme fibre [m³]; 0: not known
  /// In place of a beam: then nothing above counts, there is no mass, and no axial force that stiffens.
  std::optional<Bushing> bushing = {};
};

/// @throws std::invalid_argument if a value is outside its range stated above (names function, member, value)
void check_beam_properties(const BeamProperties& properties, const char* function);

}  // namespace sprung::fem
