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

/// Brings a closed file to the disk and gives it its final name.
/// @throws InputError with the system's reason
void rename_to_target(const std::filesystem::path& temporary, const std::filesystem::path& target);

/// The folder a path is in, "." where it names none.
std::filesystem::path folder_of(const std::filesystem::path& path);

}  // namespace sprung::support
