#pragma once

#include <filesystem>

namespace sprung::support {

/// Finds, before a byte is written, what will keep a file from being written.
/// @throws InputError if the folder is missing or the target is anything but a regular file
void check_target(const std::filesystem::path& target);

/// @param temporary  the name `target` is written under until it is whole; a left-over of that name is no
/// obstacle
/// @throws InputError if another program holds its lock, or it is not a regular file
void check_temporary(const std::filesystem::path& target, const std::filesystem::path& temporary);

/// The name that `target` is written under until it is whole.
std::filesystem::path temporary_name(const std::filesystem::path& target);

/// Removes what a program that was killed left under the temporary name of `target`, unless another program
/// is writing it.
void remove_left_over(const std::filesystem::path& target);

/// Brings a closed file to the disk and gives it its final name.
/// @throws InputError with the system's reason
void rename_to_target(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// The folder a path is in, "." where it names none.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace sprung::support
