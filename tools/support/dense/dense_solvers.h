#pragma once

#include <Eigen/Core>
#include <vector>

namespace sprung::support {

/// Solves A x = b by LU factors with partial pivoting.
/// @param A  n×n   @param b  n×k   @return n×k; NaN where A is singular
Eigen::MatrixXd solve_lu(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);
Eigen::MatrixXcd solve_lu(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& b);

/// LU factors with partial pivoting, for several right-hand sides and an estimate of the condition.
struct LuFactors {
  Eigen::MatrixXd lu;                 ///< n×n, L below the diagonal (its own is 1), U
  std::vector<int> pivots = {};       ///< row i was exchanged with row pivots[i], from 1
  double reciprocal_condition = 0.0;  ///< estimated in the 1-norm; 0 where A is singular or not finite

  /// @param b  n×k   @return n×k; of use only where the reciprocal condition is not 0
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;
};
LuFactors factorise_lu(const Eigen::MatrixXd& A);

/// Solves A x = b by Cholesky factors. @param A  n×n, symmetric positive definite, or the
///           result is NaN
/// @param b  n×k
Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b);
/// The same, taking no memory. @param[in,out] A  becomes its factor   @param[in,out] x  b, becomes the
/// solution
/// @return false where A is not positive definite: x is of no use
bool solve_positive_definite_in_place(Eigen::MatrixXd& A, Eigen::MatrixXd& x);
/// Whether the Cholesky factorisation of a symmetric matrix succeeds.
bool is_positive_definite(const Eigen::MatrixXd& A);

}  // namespace sprung::support
