#pragma once

#include <filesystem>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// A direction, 1 … 6, of one of Abaqus's nodes. Those of an internal node, whose number is not positive, are
/// modal: amplitudes of a substructure's modes, or of an element's internal shapes.
Freedom make_abaqus_freedom(std::int64_t node, int direction);

/// Reads a matrix that Abaqus wrote by *MATRIX OUTPUT, in one of two forms: lines of row node, row direction,
/// column node, column direction, value (FORMAT=MATRIX INPUT), or of row, column, value (FORMAT=COORDINATE).
/// Comments (**) are left out. SCALE FACTOR of a line *MATRIX INPUT multiplies all entries.
///
/// @param freedoms   of the first form: gets the freedoms that the file names; of the second: those of its
///                   rows, which `has_table` says are known
/// @throws support::InputError at the place of the fault: a line of another form, a row outside of the table
///         of freedoms, a keyword of another option, another parameter of *MATRIX INPUT than NAME,
///         TYPE=SYMMETRIC and SCALE FACTOR
/// Source: [Abaqus 2016], "Generating matrices" — checked by tests/reduce/matrices/matrices_test.py
MatrixEntries read_abaqus_matrix(const std::filesystem::path& path, FreedomList& freedoms, bool has_table);

}  // namespace sprung::reduce
