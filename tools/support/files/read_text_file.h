#pragma once

#include <filesystem>
#include <string>

namespace sprung::support {

/// Whether a path leads to a regular file; false, too, where that cannot be found out, as of a name that is
/// too long.
bool is_regular_file(const std::filesystem::path& path);

/// The content of a text file.
/// @throws InputError if it is missing, is a folder, or cannot be read
std::string read_text_file(const std::filesystem::path& path);

}  // namespace sprung::support
