#pragma once

#include <Eigen/Core>

namespace sprung::dynamics {

/// A constant matrix between the modes of a body, for the products of each evaluation: only its diagonal is
/// multiplied where nothing else is more than a rounding error, and nothing where all entries are.
class ModalMatrix {
 public:
  /// @param matrix  n×n
  /// @param sizes   n, ≥ 0: entry i, j is a rounding error below 1e-12 √(sizes_i sizes_j)
  ModalMatrix(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& sizes);

  bool is_zero() const { return kind_ == Kind::kZero; }
  bool is_diagonal() const { return kind_ != Kind::kFull; }

  /// y = A x. @param x  n   @param[out] y  n, other memory than x
  /// Checked by tests/dynamics/bodies/modal_matrix_test.cpp
  void multiply(const double* x, double* y) const;

 private:
  enum class Kind { kZero, kDiagonal, kFull };

  Eigen::MatrixXd matrix_;  // n×n, or the n×1 diagonal
  Kind kind_;
};

}  // namespace sprung::dynamics
