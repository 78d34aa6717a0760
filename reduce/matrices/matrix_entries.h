#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "reduce/matrices/freedoms.h"
#include "reduce/matrices/text_lines.h"

namespace sprung::reduce {

/// An entry of a matrix as a file gives it.
struct MatrixEntry {
  int row = 0, column = 0;  ///< 0-based
  double value = 0.0;
  int line = 0, text_column = 0;  ///< where it stands in the file
};

/// The entries that a file gives of a symmetric matrix: those of one triangle, or those of both.
struct MatrixEntries {
  std::string path;
  std::vector<MatrixEntry> items;
  bool is_full = false;  ///< the file says that both triangles stand there
};

/// The matrix. Where any entry stands on both sides of the diagonal, all have to, and both values must be
/// equal to 1e-6, or to 1e-9 of the diagonal.
/// @throws support::InputError at an entry that stands twice or has no equal on the other side
/// Checked by tests/reduce/matrices/matrix_errors_test.py
Eigen::SparseMatrix<double> make_symmetric_matrix(MatrixEntries entries, const FreedomList& freedoms);

/// Adds an entry with the place of its value. Abaqus writes 1e36 on the diagonal of a freedom that a boundary
/// condition holds; such a matrix is not that of a free body.
/// @throws support::InputError at the value if it is 1e30 or more
void add_entry(const TextLines& lines, int row, int column, const TextField& value, MatrixEntries& entries);

}  // namespace sprung::reduce
