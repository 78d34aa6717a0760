#pragma once

#include <optional>
#include <vector>

#include "dynamics/response/linear_outputs.h"
#include "dynamics/response/random_response.h"

namespace sprung::dynamics {

/// Change of the size of each output where some modal coordinates are held: (with them held)/(with all) − 1.
/// An output whose size is below a thousandth of the largest one in the same unit counts as having that size.
/// The sizes are root mean squares on a random road or, without one, of the transfer function over the
/// logarithm of the frequency; both by the trapezoidal rule over 2000 frequencies (response, eqs. 6, 7).
/// @param outputs      p
/// @param coordinates  held, as positions in q
/// @param road         null: none
/// @param speed        > 0 [m/s]
/// @return p; 0 where no output has a size
/// Checked by tests/verification/response_limits_test.py
Eigen::VectorXd calc_effect_of_holding(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       const std::vector<int>& coordinates, const RoadSpectrum* road,
                                       double speed, const FrequencyRange& range);

}  // namespace sprung::dynamics
