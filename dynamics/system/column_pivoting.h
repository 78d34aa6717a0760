#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace sprung::dynamics {

/// The columns that QR with column pivoting takes from a sparse matrix, in their order: always the one with the most
/// left when what lies along the others is taken away. Found by Gram–Schmidt on the sparse columns themselves, so that
/// the work grows with what is coupled. Columns that are equal to rounding are taken in ascending order.
/// Source: [Golub & Van Loan 2013], §§5.2.8, 5.4.2
struct ColumnPivots {
  std::vector<int> columns;   ///< as many as rows at most; fewer where nothing more is left
  std::vector<double> norms;  ///< of what was left of each, descending
};
ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix);

}  // namespace sprung::dynamics
