#pragma once

#include "reduce/modes/sparse_factor.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

/// A stiffness that is not positive definite to rounding.
class IndefiniteStiffness : public support::NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// The factors of a held frame's stiffness.
class StiffnessFactor {
 public:
  /// @param stiffness  n×n, symmetric
  /// @throws IndefiniteStiffness if it is not positive definite to rounding
  explicit StiffnessFactor(const SparseMatrix& stiffness);

  /// K⁻¹ x.  @param x  n×k, best of all columns at once
  Eigen::MatrixXd solve(const Eigen::MatrixXd& x) const { return factor_->solve(x); }
  /// The order of elimination, which serves K − σM as well.
  std::span<const int> order() const { return factor_->order(); }

 private:
  std::unique_ptr<SparseFactor> factor_;
};

}  // namespace sprung::reduce
