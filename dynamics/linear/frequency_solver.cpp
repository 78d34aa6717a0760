#include "dynamics/linear/frequency_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <stdexcept>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

// Scale of a mode without stiffness, of the stiffest: only the size of its state depends on it.
constexpr double kLeastFrequency = 1e-6;

}  // namespace

FrequencySolver::FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                 const Eigen::MatrixXd& stiffness) {
  const Eigen::Index f = mass.rows();
  for (const Eigen::MatrixXd* matrix : {&mass, &damping, &stiffness}) {
    if (matrix->rows() == f && matrix->cols() == f && f > 0) continue;
    throw std::invalid_argument(
        fmt::format("FrequencySolver: matrices must be square and of one size > 0, got {}×{}", matrix->rows(),
                    matrix->cols()));
  }
  const auto undamped = support::solve_undamped(stiffness, mass);
  if (!undamped) {
    throw support::NumericalError("frequency response: the mass matrix is not positive definite");
  }
  V_ = undamped->vectors;
  const Eigen::MatrixXd K = V_.transpose() * stiffness * V_;
  const double stiffest = K.diagonal().cwiseAbs().maxCoeff();
  const double least = stiffest > 0.0 ? kLeastFrequency * std::sqrt(stiffest) : 1.0;
  scale_ = K.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(least);

  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * f, 2 * f);
  A.topRightCorner(f, f) = scale_.asDiagonal();
  A.bottomLeftCorner(f, f) = -K * scale_.cwiseInverse().asDiagonal();
  A.bottomRightCorner(f, f) = -V_.transpose() * damping * V_;
  const auto schur = support::make_schur_form(A);
  if (!schur) {
    throw support::NumericalError("frequency response: no eigenvalues were found for the damped system");
  }
  U_ = schur->U;
  T_ = schur->T;
}

Eigen::MatrixXcd FrequencySolver::solve(double omega, const Eigen::MatrixXcd& force) const {
  if (!(omega > 0.0)) {
    throw std::invalid_argument(
        fmt::format("FrequencySolver::solve: omega must be > 0 rad/s, got {}", omega));
  }
  const std::complex<double> s(0.0, omega);
  const Eigen::Index f = V_.rows();
  // (sI − A)(√|k| x, ẋ) = (0, Vᵀ F)
  Eigen::MatrixXcd triangle = -T_;
  triangle.diagonal().array() += s;
  Eigen::MatrixXcd state = U_.bottomRows(f).adjoint() * (V_.transpose() * force);
  triangle.triangularView<Eigen::Upper>().solveInPlace(state);
  // Each x from that of its two states which is the larger: above a mode's own frequency x = ẋ/s.
  const Eigen::MatrixXcd displacement = U_.topRows(f) * state, rate = U_.bottomRows(f) * state;
  Eigen::MatrixXcd x(f, force.cols());
  for (Eigen::Index k = 0; k < f; ++k) {
    if (scale_[k] > omega) {
      x.row(k) = displacement.row(k) / scale_[k];
    } else {
      x.row(k) = rate.row(k) / s;
    }
  }
  return V_ * x;
}

}  // namespace sprung::dynamics
