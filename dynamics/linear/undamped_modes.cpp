#include "dynamics/linear/undamped_modes.h"

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "tools/support/dense/eigenproblems.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMaxSweeps = 8;  // two are needed: the matrix is nearly diagonal at the start

// Makes K diagonal by Jacobi rotations, which are applied to V as well, until each off-diagonal entry is
// rounding relative to its two modes. @return whether there was a rotation
bool sweep(Eigen::MatrixXd& K, Eigen::MatrixXd& V) {
  bool has_rotated = false;
  for (Eigen::Index j = 1; j < K.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) {
      if (std::abs(K(i, j)) <= kEpsilon * std::sqrt(std::abs(K(i, i) * K(j, j)))) continue;
      Eigen::JacobiRotation<double> rotation;
      if (!rotation.makeJacobi(K, i, j)) continue;
      K.applyOnTheLeft(i, j, rotation.adjoint());
      K.applyOnTheRight(i, j, rotation);
      V.applyOnTheRight(i, j, rotation);
      has_rotated = true;
    }
  }
  return has_rotated;
}

}  // namespace

Eigen::MatrixXd calc_matrix_rounding(const Eigen::MatrixXd& stiffness) {
  return kRoundingUnit * stiffness.cwiseAbs();
}

UndampedModes calc_undamped_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                                  const Eigen::MatrixXd& rounding) {
  const auto solved = support::solve_undamped(stiffness, mass);
  if (!solved) throw support::NumericalError("undamped modes: the mass matrix is not positive definite");
  Eigen::MatrixXd V = solved->vectors;
  Eigen::MatrixXd K = V.transpose() * (0.5 * (stiffness + stiffness.transpose())) * V;
  for (int count = 0; count < kMaxSweeps && sweep(K, V); ++count) {
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(K.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return K(a, a) < K(b, b); });
  UndampedModes modes;
  modes.omega_squared = K.diagonal()(order);
  modes.vectors = V(Eigen::all, order);
  const Eigen::MatrixXd sizes = modes.vectors.cwiseAbs();
  modes.rounding = (sizes.array() * (rounding * sizes).array()).colwise().sum().transpose();
  // The entries of the vectors have rounding errors themselves.
  const Eigen::VectorXd entries = kRoundingUnit * sizes.rowwise().maxCoeff();
  modes.rounding.array() += entries.dot(stiffness.cwiseAbs() * entries);
  return modes;
}

}  // namespace sprung::dynamics
