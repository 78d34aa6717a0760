#pragma once

#include <string>
#include <vector>

#include "dynamics/linear/random_response.h"

namespace sprung::dynamics {

/// A force element whose state has been linearised for its own random motion.
struct LinearisedFriction {
  std::string element;          ///< its name
  double rms_deflection = 0.0;  ///< [m]
};

/// Gives each state that has no derivative at rest, as that of friction, the linear law that belongs to the
/// root mean squares of its element's own motion on the road, which depend on these laws (linear,
/// "Friction").
/// @param[in,out] vehicle  linearised at rest
/// @return the elements; empty where there are none
/// @throws support::NumericalError as calc_root_mean_squares, and where the iteration does not settle
/// Checked by tests/verification/suspension_test.py
std::vector<LinearisedFriction> linearise_friction_by_response(LinearVehicle& vehicle,
                                                               const RoadSpectrum& road, double speed,
                                                               const FrequencyRange& range);

}  // namespace sprung::dynamics
