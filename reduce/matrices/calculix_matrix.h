#pragma once

#include <filesystem>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// Reads a matrix that CalculiX wrote by *FREQUENCY, SOLVER=MATRIXSTORAGE: `.sti` or `.mas`, lines of row,
/// column, value of one triangle.
/// @param freedoms  as from read_calculix_freedoms
/// @throws support::InputError at the place of the fault
/// Checked by tests/reduce/matrices/matrices_test.py
MatrixEntries read_calculix_matrix(const std::filesystem::path& path, const FreedomList& freedoms);

}  // namespace sprung::reduce
