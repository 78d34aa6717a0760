#pragma once

#include <filesystem>
#include <string_view>

#include "dynamics/output/response_result.h"

namespace sprung::dynamics {

/// Root attribute `format` of a response file.
inline constexpr std::string_view kResponseFormat = "sprung-response";

/// Writes a response file (dynamics/output/response.md). On failure no file is left.
/// @throws support::InputError if it cannot be written
void write_response(const std::filesystem::path& path, const ResponseResult& result);

}  // namespace sprung::dynamics
