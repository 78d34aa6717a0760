#pragma once

#include <filesystem>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// Reads a matrix that Abaqus wrote by *MATRIX OUTPUT, in one of two forms: lines of row node, row direction,
/// column node, column direction, value (FORMAT=MATRIX INPUT), or of row, column, value (FORMAT=COORDINATE).
/// Comments (**) and a line *MATRIX INPUT are left out. A freedom of an internal node, whose number is not
/// positive, is modal.
///
/// @param freedoms   of the first form: gets the freedoms that the file names; of the second: those of its
///                   rows, which `has_table` says are known
/// @throws support::InputError at the place of the fault: a line of another form, a row outside of the table
///         of freedoms, an internal node with more than one freedom, a keyword of another option
/// Source: [Abaqus 2016], "Generating matrices" — checked by tests/reduce/matrices/matrices_test.py
MatrixEntries read_abaqus_matrix(const std::filesystem::path& path, FreedomList& freedoms, bool has_table);

}  // namespace sprung::reduce
