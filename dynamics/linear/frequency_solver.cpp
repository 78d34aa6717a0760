#include "dynamics/linear/frequency_solver.h"

#include <fmt/format.h>

#include <complex>
#include <stdexcept>

#include "dynamics/linear/undamped_modes.h"
#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

FrequencySolver::FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                 const Eigen::MatrixXd& stiffness)
    : FrequencySolver(mass, damping, stiffness, calc_matrix_rounding(stiffness)) {}

FrequencySolver::FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                 const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding) {
  const Eigen::Index f = mass.rows();
  for (const Eigen::MatrixXd* matrix : {&mass, &damping, &stiffness, &rounding}) {
    if (matrix->rows() == f && matrix->cols() == f && f > 0) continue;
    throw std::invalid_argument(
        fmt::format("FrequencySolver: matrices must be square and of one size > 0, got {}×{}", matrix->rows(),
                    matrix->cols()));
  }
  form_ = make_first_order_form(mass, damping, stiffness, rounding);
  const auto schur = support::make_schur_form(form_.A);
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
  const Eigen::Index f = form_.V.rows();
  // (sI − A) z = (0, Vᵀ F)
  Eigen::MatrixXcd triangle = -T_;
  triangle.diagonal().array() += s;
  Eigen::MatrixXcd states = U_.bottomRows(f).adjoint() * (form_.V.transpose() * force);
  triangle.triangularView<Eigen::Upper>().solveInPlace(states);
  return form_.V * form_.calc_amplitudes(U_ * states, s);
}

}  // namespace sprung::dynamics
