#pragma once

#include <string>
#include <string_view>

namespace sprung::dynamics {

/// Refuses content that is not text in UTF-8 (which includes ASCII): binary data, UTF-16, Latin-1.
/// @param lines_before  lines at the beginning that are not checked
/// @throws support::InputError at the first byte that cannot be
void check_text(std::string_view text, const std::string& path, int lines_before = 0);

}  // namespace sprung::dynamics
