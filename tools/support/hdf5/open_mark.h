#pragma once

#include <cstdint>

namespace sprung::support::hdf5 {

/// HDF5 marks a file that is open for writing, in a byte of its superblock, and refuses to read it as long as
/// the mark is there. These two set and clear the mark in a file that this process has open, so that what has
/// been flushed can be read even if the process is killed.
///
/// @param file  identifier of a file of format version 1.10
/// @throws Failure if the superblock is another, or cannot be read or written
/// Source: HDF5 File Format Specification Version 3.0, II.A "Format Signature and Superblock", version 3
void set_open_mark(std::int64_t file);
void clear_open_mark(std::int64_t file);

/// Leaves the file as it is on the disk: what HDF5 writes from now on, as when it closes the file, is lost.
void discard_further_writes(std::int64_t file) noexcept;

}  // namespace sprung::support::hdf5
