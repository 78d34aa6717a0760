#pragma once

#include "reduce/factors/sparse_factor.h"
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
  /// Factors of K − σM where M has no entries but where K has some, in the same order of elimination.
  /// @return null where a pivot vanishes
  std::unique_ptr<SparseFactor> factor_like(const SparseMatrix& shifted) const {
    return factor_->factor_like(shifted);
  }

 private:
  std::unique_ptr<SparseFactor> factor_;
};

}  // namespace sprung::reduce
