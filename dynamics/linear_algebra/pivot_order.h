#pragma once

#include <span>
#include <vector>

namespace sprung::dynamics {

struct MatrixPosition {
  int row, column;
};

/// One step of an elimination: its pivot, and the other entries of the pivot's row and column at that step.
struct EliminationStep {
  int row, column;         ///< of the matrix
  std::vector<int> upper;  ///< columns of the entries in the pivot's row
  std::vector<int> lower;  ///< rows of the entries in the pivot's column
};

/// Pivots of a sparse LU factorisation, chosen for little fill-in among entries that are not small in their
/// row (Markowitz's rule with a threshold). Source: [Duff, Erisman & Reid 2017], §§5.2, 7.2
/// @param entries  the pattern; the values of entries at one position are added
/// @param values   one for each entry
/// @return one for each row; any where the values are not numbers
/// Checked by tests/dynamics/linear_algebra/sparse_factors_test.cpp
std::vector<EliminationStep> choose_pivot_order(int size, const std::vector<MatrixPosition>& entries,
                                                std::span<const double> values);

}  // namespace sprung::dynamics
