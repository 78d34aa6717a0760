#pragma once

#include "fem/beam_element.h"

namespace sprung::fem {

/// Rates of change of a section's properties with some number of a design.
struct BeamPropertyRates {
  double axial_rigidity = 0.0, bending_rigidity = 0.0;
  double shear_rigidity = 0.0;  ///< not read of a section without shear deformation
  double mass_per_length = 0.0, rotary_inertia = 0.0;
};

/// Rates of change of a beam element with some number of a design.
struct BeamElementRates {
  Eigen::Vector2d first = Eigen::Vector2d::Zero(), second = Eigen::Vector2d::Zero();  ///< of its ends
  BeamPropertyRates properties = {};
};

/// Rate of the stiffness and of the mass in mesh axes, in closed form (fem, eqs. 25–28).
/// @throws std::invalid_argument if the ends coincide or properties are out of range
/// Checked by tests/fem/element_rates_test.cpp
Matrix6 calc_stiffness_rate(const BeamElement& element, const BeamElementRates& rates);
Matrix6 calc_mass_rate(const BeamElement& element, const BeamElementRates& rates);

}  // namespace sprung::fem
