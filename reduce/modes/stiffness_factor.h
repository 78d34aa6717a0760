#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace sprung::reduce {

/// The factors of a held frame's stiffness.
class StiffnessFactor {
 public:
  /// @param stiffness  n×n, symmetric
  /// @throws support::NumericalError if it is not positive definite to rounding
  explicit StiffnessFactor(const Eigen::SparseMatrix<double>& stiffness);

  Eigen::Index size() const { return factor_.rows(); }
  /// K⁻¹ x.  @param x  n×k
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return factor_.solve(x); }

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace sprung::reduce
