#pragma once

// Private to this room: the file that Hdf5Writer makes, and its attributes.

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/support/hdf5/hdf5_handle.h"

namespace sprung::support::hdf5 {

/// A new file, open for writing, in place of what is there. HDF5 would truncate it before it takes its own
/// lock, so the caller has to have it locked.
/// @param keeps_order  whether the root can be listed in the order in which its objects were made
Hdf5Handle create_file(const std::filesystem::path& path, bool keeps_order = false);

/// From now on nothing of the file's structure goes to the disk between two flushes: what a flush has written
/// stays readable until the next.
/// @param file  from create_file, just flushed
void hold_structure_between_flushes(std::int64_t file);

/// Removes an attribute, if there is one of this name.
void remove_attribute(std::int64_t object, const std::string& name);

/// Writes an attribute, or another value of an older one of the same type in its place: nothing of what is on
/// the disk is given up.
/// @param value  of the memory type
void write_scalar_attribute(std::int64_t object, const std::string& name, std::int64_t file_type,
                            std::int64_t memory_type, const void* value);

}  // namespace sprung::support::hdf5
