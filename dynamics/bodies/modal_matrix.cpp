#include "dynamics/bodies/modal_matrix.h"

#include <algorithm>
#include <cmath>

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

constexpr double kRoundingOfEntries = 1e-12;  // of modes that are normalised to unit mass

}  // namespace

ModalMatrix::ModalMatrix(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& sizes) : kind_(Kind::kZero) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      if (!(std::abs(matrix(i, j)) > kRoundingOfEntries * std::sqrt(sizes[i] * sizes[j]))) continue;
      kind_ = std::max(kind_, i == j ? Kind::kDiagonal : Kind::kFull);
    }
  }
  if (kind_ == Kind::kDiagonal)
    matrix_ = matrix.diagonal();
  else
    matrix_ = matrix;
}

void ModalMatrix::multiply(const double* x, double* y) const {
  const Eigen::Index n = matrix_.rows();
  switch (kind_) {
    case Kind::kZero:
      std::fill(y, y + n, 0.0);
      return;
    case Kind::kDiagonal:
      for (Eigen::Index k = 0; k < n; ++k) y[k] = matrix_.data()[k] * x[k];
      return;
    case Kind::kFull:
      support::multiply(matrix_, x, y);
      return;
  }
}

}  // namespace sprung::dynamics
