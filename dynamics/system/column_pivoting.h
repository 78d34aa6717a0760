#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace sprung::dynamics {

/// The columns that QR with column pivoting takes from a sparse matrix A, in their order: always the one with
/// the most left when what lies along those before is taken away. Found as the pivots of Cholesky on AᵀA, so
/// that the work grows with what is coupled. Columns that are equal to rounding are taken in ascending order.
/// Of more than 150 rows the elimination couples ever more columns in that order; there a column counts as equal to
/// others up to four times its length, and the one that is coupled with the fewest is taken first.
/// Where a pivot falls below 1e-6 of the first, which AᵀA no longer tells from rounding, the dense
/// decomposition decides. Source: [Golub & Van Loan 2013], §§4.2.8, 5.4.2
struct ColumnPivots {
  std::vector<int> columns;   ///< as many as A has rows
  std::vector<double> norms;  ///< of what was left of each
};
/// @param matrix  no more rows than columns
ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix);

}  // namespace sprung::dynamics
