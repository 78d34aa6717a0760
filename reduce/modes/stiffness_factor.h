#pragma once

#include "reduce/modes/sparse_factor.h"

namespace sprung::reduce {

/// The factors of a held frame's stiffness.
class StiffnessFactor {
 public:
  /// @param stiffness  n×n, symmetric
  /// @throws support::NumericalError if it is not positive definite to rounding
  explicit StiffnessFactor(const SparseMatrix& stiffness);

  /// K⁻¹ x.  @param x  n×k, best of all columns at once
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return factor_->solve(x); }
  /// The order of elimination, which serves K − σM as well.
  std::span<const int> order() const { return factor_->order(); }

 private:
  std::unique_ptr<SparseFactor> factor_;
};

}  // namespace sprung::reduce
