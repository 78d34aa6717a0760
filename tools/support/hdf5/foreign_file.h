#pragma once

#include <filesystem>
#include <string_view>

namespace sprung::support {

/// Whether the file at `path` was written by another program, so that it must not be replaced: it is not
/// empty and not HDF5, or HDF5 of another format. A damaged HDF5 file may be replaced.
/// @param format  value of the root attribute `format` of this project's files
bool is_foreign_file(const std::filesystem::path& path, std::string_view format);

}  // namespace sprung::support
