#pragma once

#include <filesystem>

#include "reduce/matrices/matrix_entries.h"

namespace sprung::reduce {

/// Reads a Matrix Market file: real or integer, symmetric or general, `coordinate` or `array`.
/// @param freedoms  those of its rows
/// @throws support::InputError at the place of the fault: another kind of matrix, another size than the table
///         of freedoms, an entry outside of it or above the diagonal of a symmetric matrix, a file cut short
/// Source: [Boisvert et al. 1996] — checked by tests/reduce/matrices/matrices_test.py
MatrixEntries read_matrix_market(const std::filesystem::path& path, const FreedomList& freedoms);

}  // namespace sprung::reduce
