#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace sprung::dynamics {

/// As many columns of a sparse matrix as it has rows, so chosen that they are regular and the others are made
/// of them by factors that are not large.
///
/// Of up to 150 rows the columns that QR with column pivoting takes, in their order: always the one with the
/// most left when what lies along those before is taken away; of columns that are equal to rounding the
/// first. Source: [Golub & Van Loan 2013], §5.4.2
///
/// Of more rows that would come to ask for all products of columns. There the pivots of Gaussian elimination:
/// sizes up to twice one another count as equal, and of the rows with the largest entries that with the
/// fewest is taken, of its columns the one that is in the fewest rows; so the work grows with the entries of
/// the factors. Source: [Duff, Erisman & Reid 2017], §§5.2, 7.2; [Wehage & Haug 1982]
///
/// Where a pivot falls below 1e-6 of the largest before, the dense decomposition decides.
struct ColumnPivots {
  std::vector<int> columns;   ///< as many as A has rows
  std::vector<double> sizes;  ///< of what was left of each; of the pivot
};
/// @param matrix  no more rows than columns
ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix);

}  // namespace sprung::dynamics
