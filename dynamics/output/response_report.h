#pragma once

#include <string>

#include "dynamics/output/response_result.h"

namespace sprung::dynamics {

/// What the driver and the suspension get to feel, as tables for people: vertical motion of the points,
/// forces and deflections.
std::string format_response(const ResponseResult& result);
/// All outputs as one JSON object, SI units.
std::string format_response_json(const ResponseResult& result);

}  // namespace sprung::dynamics
