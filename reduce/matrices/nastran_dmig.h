#pragma once

#include <filesystem>
#include <string>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// Reads a matrix from DMIG entries of a Nastran punch file: fields of 8 or 16 columns or between commas,
/// real, square or symmetric. Matrices of other names and the other entries of an external superelement are
/// left out.
///
/// @param name      of the matrix; "" for the only one of the file
/// @param freedoms  gets the freedoms that the file names
/// @throws support::InputError at the place of the fault: no matrix of that name, several without a name, a
///         complex or rectangular matrix, entries before its header, a point that is both a grid point and a
///         scalar point (direction 0 or none, a modal freedom), a grid point whose displacements are not in
///         the basic system, entries that belong to no external superelement
/// Source: [NX Nastran 2014], "DMIG" — checked by tests/reduce/matrices/matrices_test.py
MatrixEntries read_nastran_dmig(const std::filesystem::path& path, const std::string& name,
                                FreedomList& freedoms);

}  // namespace sprung::reduce
