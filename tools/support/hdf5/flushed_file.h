#pragma once

// Private to this room: a file as H5Fflush has left it on the disk.

#include <cstdint>
#include <filesystem>

namespace sprung::support::hdf5 {

/// Asks the system for the space of a flush that is to follow, where the file system can. A disk that is full
/// then says so before the flush has changed the file.
/// @param file  identifier of the file at `path`, open for writing
/// @throws Failure if the space is not there
void reserve_space(std::int64_t file, const std::filesystem::path& path);

/// Makes the file readable as a flush has left it; what HDF5 writes from now on, as when it closes the file,
/// is lost.
/// @param size  of the file behind that flush [bytes]. What was written beyond is given up first: some file
/// systems need space to change anything
/// @throws Failure if the file cannot be written
void keep_as_flushed(std::int64_t file, std::uintmax_t size);

/// A readable copy of a file that has just been flushed.
/// @param copy  an existing file, which gets this content
/// @throws Failure with the system's reason, also if less than twice the size that it takes is free on the
/// disk: a copy is to leave room for the file itself
void copy_flushed(const std::filesystem::path& file, const std::filesystem::path& copy);

}  // namespace sprung::support::hdf5
