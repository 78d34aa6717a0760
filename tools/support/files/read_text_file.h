#pragma once

#include <filesystem>
#include <string>

namespace sprung::support {

/// The content of a text file.
/// @throws InputError if it is missing, is a folder, or cannot be read
std::string read_text_file(const std::filesystem::path& path);

}  // namespace sprung::support
