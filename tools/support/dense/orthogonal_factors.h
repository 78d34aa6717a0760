#pragma once

#include <Eigen/Core>

namespace sprung::support {

/// Orthonormal columns, of which the first `rank` span the columns of a matrix.
struct ColumnSpace {
  Eigen::MatrixXd basis;
  Eigen::Index rank = 0;
};
/// By QR factors with column pivoting. The basis is NaN and the rank 0 where A is not finite.
/// @param num_columns  of the basis, at most A's rows
ColumnSpace find_column_space(const Eigen::MatrixXd& A, Eigen::Index num_columns);

/// An orthogonal matrix whose first column lies along a vector. @param direction  n, not zero   @return n×n
Eigen::MatrixXd make_rotation_onto(const Eigen::VectorXd& direction);

/// Among the x that make |A x − b| least, the shortest. @param A  m×n, of any rank   @param b  m×k
/// @return n×k; NaN where A or b is not finite
Eigen::MatrixXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);

/// Singular values, descending, with singular vectors as columns. They are NaN where the iteration does not
/// converge, as for an A that is not finite. Values much smaller than the largest are accurate to its
/// rounding.
struct SingularPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
/// @param A  m×n   @return min(m, n)
Eigen::VectorXd calc_singular_values(const Eigen::MatrixXd& A);
/// As above, with all m left vectors: those beyond min(m, n) complete the basis.
SingularPairs calc_left_singular_pairs(const Eigen::MatrixXd& A);
/// With the right vectors, n×min(m, n).
SingularPairs calc_right_singular_pairs(const Eigen::MatrixXd& A);

}  // namespace sprung::support
