#pragma once

#include <cstddef>
#include <vector>

namespace sprung::dynamics {

/// An entry of a sparse matrix that is known by its pattern.
struct PatternEntry {
  int row, column;
  std::size_t source;  ///< where its value comes from
};
/// Of each row; entries of one row may share a place.
using PatternRows = std::vector<std::vector<PatternEntry>>;

/// Block triangular form of a square sparse matrix. Source: [Duff & Reid 1978], [Tarjan 1972]
struct BlockTriangularForm {
  bool is_regular = false;         ///< whether there is a matrix of that pattern that has an inverse
  std::vector<int> column_of_row;  ///< an entry of each row such that no two share a column
  std::vector<std::vector<int>>
      groups;  ///< rows of the blocks, ascending in each; each after those that it needs
};
/// @param rows  of as many columns
BlockTriangularForm find_block_triangular_form(const PatternRows& rows);

}  // namespace sprung::dynamics
