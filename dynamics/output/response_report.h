#pragma once

#include <string>

#include "dynamics/output/response_result.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// The main outputs as a text table: vertical motion of the points, forces and deflections of force elements.
std::string format_response(const ResponseResult& result);
/// All outputs as one JSON object, SI units, without the warnings.
support::Json make_response_json(const ResponseResult& result);

}  // namespace sprung::dynamics
