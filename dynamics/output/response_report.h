#pragma once

#include <string>

#include "dynamics/output/response_result.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// Whether an output is one of the main ones: vertical motion of points, forces, torques and deflections of
/// force elements.
bool is_main_output(const OutputSubject& subject);
/// The main outputs as a text table.
std::string format_response(const ResponseResult& result);
/// All outputs as one JSON object, SI units, without the warnings.
support::Json make_response_json(const ResponseResult& result);

}  // namespace sprung::dynamics
