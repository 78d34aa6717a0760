#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sprung::support {

/// JSON whose members keep the order in which they were added. Numbers that are not finite are written as
/// null.
using Json = nlohmann::ordered_json;

/// The text of `--json`: one line. Bytes that are not UTF-8 are replaced.
inline std::string format_json(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sprung::support
