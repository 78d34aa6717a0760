#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dynamics/response/random_response.h"

namespace sprung::dynamics {

/// A force element with laws that have been linearised for its own random motion.
struct RandomLinearisation {
  std::string element;                            ///< its name
  bool has_states = false;                        ///< friction or orifices: laws of its states
  double rms_deflection = 0.0;                    ///< [m]
  std::vector<double> rms_rates = {};             ///< of its dampers, where one has more than one slope
  std::vector<std::string_view> rate_units = {};  ///< of these
};

/// The laws of an element that are far from linear near rest, for a motion that is usual for it; empty where
/// it has none (ForceElement::linearise_for_random_motion).
RandomLaws find_random_laws(const LinearVehicle& vehicle, std::size_t force);

/// Gives elements whose laws are far from linear, as those of friction and of dampers with more than one
/// slope, the linear laws that belong to the root mean squares of the element's own motion on the road, which
/// depend on these laws (response, "Laws for random motion").
/// @param[in,out] vehicle  linearised at rest
/// @return the elements; empty where there are none
/// @throws support::NumericalError as calc_root_mean_squares, and where the iteration does not settle
/// Checked by tests/verification/damper_response_test.py, suspension_test.py and air_spring_test.py
std::vector<RandomLinearisation> linearise_for_random_motion(LinearVehicle& vehicle, const RoadSpectrum& road,
                                                             double speed, const FrequencyRange& range);

}  // namespace sprung::dynamics
