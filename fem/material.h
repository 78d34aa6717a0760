#pragma once

#include <string>

namespace sprung::fem {

/// Isotropic linear elastic material.
struct Material {
  std::string name;
  double youngs_modulus = 0.0;  ///< E > 0 [Pa]
  double density = 0.0;         ///< ρ ≥ 0 [kg/m³]; 0: the sections give their mass per length themselves
  double poissons_ratio = 0.0;  ///< ν, −1 < ν ≤ 0.5 [-]
};

/// Shear modulus G = E / (2 (1 + ν)) [Pa].
inline double calc_shear_modulus(const Material& material) {
  return material.youngs_modulus / (2.0 * (1.0 + material.poissons_ratio));
}

}  // namespace sprung::fem
