#pragma once

#include <filesystem>
#include <string_view>

#include "tools/support/errors/input_error.h"

namespace sprung::support {

/// Checks, before anything is written, that a file can be written.
/// @throws InputError if the folder is missing, or if the target exists and is not a regular file
void check_target(const std::filesystem::path& target);

/// Checks that a file that belongs to the target is a regular one, or is not there.
/// @throws InputError that it is in the way
void check_replaceable(const std::filesystem::path& target, const std::filesystem::path& other);

/// The name of `target` until it is complete.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Removes the temporary file of `target` that a killed program has left, unless another program is writing
/// it.
void remove_left_over(const std::filesystem::path& target);

/// The error that a target cannot be written.
InputError cannot_be_written(const std::filesystem::path& target, std::string_view reason);

/// The folder of a path; "." if the path has none.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace sprung::support
