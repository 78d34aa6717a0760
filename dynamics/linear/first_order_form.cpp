#include "dynamics/linear/first_order_form.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/linear/undamped_modes.h"

namespace sprung::dynamics {

namespace {

// Of the largest |s|. The rounding of the eigenvalues of A is about 1e-14 of it; that of the differences
// which give stiffness and damping is 1e-11 of each. A double eigenvalue has the square root of these errors,
// but the double zero of a free mode is avoided, as its position is no state.
constexpr double kEigenvalueRounding = 1e-9;

}  // namespace

FirstOrderForm make_first_order_form(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                     const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding) {
  const UndampedModes modes = calc_undamped_modes(stiffness, mass, rounding);
  const Eigen::Index f = mass.rows();
  std::vector<Eigen::Index> order, bound;
  for (Eigen::Index k = 0; k < f; ++k) (modes.is_free(k) ? order : bound).push_back(k);
  FirstOrderForm form;
  form.num_free = static_cast<Eigen::Index>(order.size());
  order.insert(order.end(), bound.begin(), bound.end());
  form.V = modes.vectors(Eigen::all, order);
  form.scale = modes.omega_squared(bound).cwiseAbs().cwiseSqrt();
  form.rounding = modes.rounding(order);
  // The modes are those of the symmetric part. The skew part, of forces without a potential, couples them.
  Eigen::MatrixXd K = form.V.transpose() * (0.5 * (stiffness - stiffness.transpose())) * form.V;
  K.diagonal() = modes.omega_squared(order);

  const Eigen::Index n = form.num_bound();
  form.A = Eigen::MatrixXd::Zero(n + f, n + f);
  form.A.block(0, n + form.num_free, n, n) = form.scale.asDiagonal();
  form.A.bottomLeftCorner(f, n) = -K.rightCols(n) * form.scale.cwiseInverse().asDiagonal();
  form.A.bottomRightCorner(f, f) = -form.V.transpose() * damping * form.V;
  return form;
}

// Each y follows from the larger of its two states: above the mode's own frequency y = ẏ/s.
Eigen::MatrixXcd FirstOrderForm::calc_amplitudes(const Eigen::MatrixXcd& states,
                                                 std::complex<double> s) const {
  Eigen::MatrixXcd y = states.bottomRows(V.rows()) / s;
  for (Eigen::Index k = 0; k < num_bound(); ++k) {
    if (scale[k] > std::abs(s)) y.row(num_free + k) = states.row(k) / scale[k];
  }
  return y;
}

double calc_eigenvalue_rounding(const Eigen::VectorXcd& eigenvalues) {
  return eigenvalues.size() == 0 ? 0.0 : kEigenvalueRounding * eigenvalues.cwiseAbs().maxCoeff();
}

bool has_growth(const Eigen::VectorXcd& eigenvalues) {
  return eigenvalues.size() > 0 && eigenvalues.real().maxCoeff() > calc_eigenvalue_rounding(eigenvalues);
}

}  // namespace sprung::dynamics
