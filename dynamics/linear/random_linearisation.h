#pragma once

#include <string>
#include <vector>

#include "dynamics/linear/random_response.h"

namespace sprung::dynamics {

/// A force element whose states have been linearised for its own random motion.
struct RandomLinearisation {
  std::string element;          ///< its name
  double rms_deflection = 0.0;  ///< [m]
};

/// Whether the law of an element's states is far from linear near rest (ForceElement::linearise_states).
bool needs_random_linearisation(const LinearVehicle& vehicle, std::size_t force);

/// Gives the states of elements whose law is far from linear near rest, as that of friction, the linear law
/// that belongs to the root mean squares of the element's own motion on the road, which depend on these laws
/// (linear, "Friction and orifices").
/// @param[in,out] vehicle  linearised at rest
/// @return the elements; empty where there are none
/// @throws support::NumericalError as calc_root_mean_squares, and where the iteration does not settle
/// Checked by tests/verification/suspension_test.py and air_spring_test.py
std::vector<RandomLinearisation> linearise_for_random_motion(LinearVehicle& vehicle, const RoadSpectrum& road,
                                                             double speed, const FrequencyRange& range);

}  // namespace sprung::dynamics
