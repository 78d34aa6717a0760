#pragma once

#include <vector>

#include "dynamics/output/response_result.h"
#include "dynamics/preparation/prepared_run.h"
#include "dynamics/response/linear_vehicle.h"

namespace sprung::dynamics {

/// What concerns the numbers of a response.
inline constexpr std::string_view kResponse = "response";

/// Inputs without effect, modes that are missing, and what is not linear: wheels off the ground or at another
/// speed, kinks at rest and, on a random road, wheels that lift, stops that are reached and springs that bend
/// within their motion.
/// @param result  complete but for its warnings
/// Checked by tests/verification/response_test.py, response_limits_test.py
std::vector<RunWarning> list_response_warnings(const PreparedRun& prepared, const LinearVehicle& vehicle,
                                               const ResponseResult& result);

}  // namespace sprung::dynamics
