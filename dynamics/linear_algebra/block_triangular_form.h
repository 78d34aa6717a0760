#pragma once

#include <cstddef>
#include <vector>

namespace sprung::dynamics {

/// An entry in the pattern of a sparse matrix.
struct PatternEntry {
  int row, column;
  std::size_t source;  ///< index of its value, for the caller's use
};
/// The entries of each row; two entries of a row may have the same column.
using PatternRows = std::vector<std::vector<PatternEntry>>;

/// Block triangular form of a square sparse matrix. Source: [Duff & Reid 1978], [Tarjan 1972]
struct BlockTriangularForm {
  bool is_regular = false;         ///< some matrix of this pattern has an inverse
  std::vector<int> column_of_row;  ///< column of one entry of each row; they all differ if is_regular
  /// Rows of the diagonal blocks, ascending in each. A block comes after those whose columns its rows
  /// contain. Empty if not is_regular.
  std::vector<std::vector<int>> groups;
};
/// @param rows  n rows, with columns from 0 to n − 1
BlockTriangularForm find_block_triangular_form(const PatternRows& rows);

}  // namespace sprung::dynamics
