#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace sprung::dynamics {

/// As many columns of a sparse matrix as it has rows. They are linearly independent if the matrix has full
/// rank, and the other columns are combinations of them whose factors are not large.
///
/// Up to 150 rows, the columns are those of QR with column pivoting, in their order: each is the longest when
/// what lies along the columns before it is removed. Of columns that are equally long down to rounding, the
/// first is taken. Source: [Golub & Van Loan 2013], §5.4.2
///
/// With more rows, the columns are those of the pivots of Gaussian elimination, whose work grows with the
/// entries of the factors only. Sizes within a factor of two count as equal. Among the rows with the largest
/// entries, the one with the fewest entries is taken, and in it the column that appears in the fewest rows.
/// Where a pivot falls below 1e-6 of the largest one before, QR decides. Source: [Duff, Erisman & Reid 2017],
/// §§5.2, 7.2; [Wehage & Haug 1982]
struct ColumnPivots {
  std::vector<int> columns;   ///< as many as the matrix has rows
  std::vector<double> sizes;  ///< length of each column, or size of its pivot, when it was taken
};
/// @param matrix  no more rows than columns
ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix);

}  // namespace sprung::dynamics
