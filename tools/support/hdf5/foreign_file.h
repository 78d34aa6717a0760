#pragma once

#include <filesystem>
#include <string_view>

namespace sprung::support {

/// Whether a file stands at `path` that is somebody else's: not empty, and not HDF5 of this format. A damaged
/// HDF5 file is nobody's: it may be replaced.
/// @param format  the value of the root attribute `format` of our own files
bool is_foreign_file(const std::filesystem::path& path, std::string_view format);

}  // namespace sprung::support
