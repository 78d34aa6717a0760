#pragma once

namespace sprung::support::hdf5 {

/// HDF5 marks a file that is open for writing, in a byte of its superblock, and refuses to read it as long as
/// the mark is there. This clears the mark, so that what has been flushed can be read.
///
/// @param descriptor  of a file of format version 1.10, open for reading and writing
/// @throws Failure if the superblock is another, or cannot be read or written
/// Source: HDF5 File Format Specification Version 3.0, II.A "Format Signature and Superblock", version 3
void clear_open_mark(int descriptor);

}  // namespace sprung::support::hdf5
