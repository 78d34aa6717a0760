#pragma once

#include <filesystem>

namespace sprung::support {

/// Checks, before anything is written, that a file can be written.
/// @throws InputError if the folder is missing, or if the target exists and is not a regular file
void check_target(const std::filesystem::path& target);

/// Checks that the temporary file can be written. A file of that name that an earlier run has left may exist.
/// @param temporary  the name of `target` until it is complete
/// @throws InputError if another program has locked it, or if it is not a regular file
void check_temporary(const std::filesystem::path& target, const std::filesystem::path& temporary);

/// The name of `target` until it is complete.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Removes the temporary file of `target` that a killed program has left, unless another program is writing
/// it.
void remove_left_over(const std::filesystem::path& target);

/// Writes a closed file through to the disk and gives it its final name.
/// @throws InputError with the system's reason
void rename_to_target(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// The folder of a path; "." if the path has none.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace sprung::support
