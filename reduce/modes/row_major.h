#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace sprung::reduce {

/// Vectors side by side, of which the values of one freedom lie together: a sparse matrix or an element's
/// matrix is read once for all of them.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A X, in which each entry of A is read once.  @param A  m×n   @param X  n×k   @return m×k
inline Eigen::MatrixXd multiply(const Eigen::SparseMatrix<double>& A, const Eigen::MatrixXd& X) {
  if (X.cols() < 2) return A * X;
  const RowMajorMatrix rows = X;
  const RowMajorMatrix product = A * rows;
  return product;
}

}  // namespace sprung::reduce
