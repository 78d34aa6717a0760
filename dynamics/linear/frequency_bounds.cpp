#include "dynamics/linear/frequency_bounds.h"

#include <algorithm>
#include <numbers>

#include "dynamics/linear/linearisation.h"
#include "dynamics/linear/undamped_modes.h"
#include "tools/support/dense/dense_solvers.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

bool is_symmetric(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& unknown) {
  constexpr double kUnsymmetric = 1e-5;
  const Eigen::VectorXd sizes = stiffness.diagonal().cwiseAbs().cwiseSqrt();
  const Eigen::MatrixXd allowed =
      kUnsymmetric * sizes * sizes.transpose() + 2.0 * (unknown + unknown.transpose());
  return ((stiffness - stiffness.transpose()).cwiseAbs().array() <= allowed.array()).all();
}

FrequencyBounds calc_frequency_bounds(const Model& model, const Eigen::VectorXd& q,
                                      const Eigen::VectorXd& stiffness,
                                      const std::vector<Eigen::MatrixXd>& masses) {
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  Eigen::MatrixXd spread;
  LinearisedSystem system = linearise(equations, 0.0, q, {}, &spread);
  const Eigen::MatrixXd& D = system.directions;
  if (stiffness.size() > 0) system.stiffness += D.transpose() * stiffness.asDiagonal() * D;
  // Internal states, the last coordinates, have no stiffness and are no modes.
  const Eigen::Index n = system.mass.rows() - model.num_states();
  const Eigen::MatrixXd own_stiffness = system.stiffness.topLeftCorner(n, n);
  const Eigen::MatrixXd unknown = (system.stiffness_rounding + spread).topLeftCorner(n, n);
  if (!is_symmetric(own_stiffness, unknown)) {
    throw support::NumericalError(
        "brackets: the stiffness at rest is not symmetric, as with forces that follow a body; brackets are "
        "of vehicles whose forces are conservative, but for dampers");
  }
  const auto sort_frequencies = [](Eigen::VectorXd omega_squared) -> Eigen::VectorXd {
    std::sort(omega_squared.begin(), omega_squared.end());
    return omega_squared.cwiseMax(0.0).cwiseSqrt() / (2.0 * std::numbers::pi);
  };
  FrequencyBounds bounds;
  const auto add_bounds = [&](const Eigen::MatrixXd& mass) {
    const Eigen::MatrixXd own_mass = mass.topLeftCorner(n, n);
    if (!support::is_positive_definite(own_mass)) return;
    const UndampedModes modes = calc_undamped_modes(own_stiffness, own_mass, unknown);
    const Eigen::VectorXd lower = sort_frequencies(modes.omega_squared - modes.rounding),
                          upper = sort_frequencies(modes.omega_squared + modes.rounding);
    const bool is_first = bounds.lower.size() == 0;
    bounds = {.lower = is_first ? lower : bounds.lower.cwiseMax(lower),
              .upper = is_first ? upper : bounds.upper.cwiseMin(upper)};
  };
  if (masses.empty()) add_bounds(system.mass);
  for (const Eigen::MatrixXd& mass : masses) add_bounds(system.mass + D.transpose() * mass * D);
  if (n > 0 && bounds.lower.size() == 0) {
    throw support::NumericalError(
        "brackets: the bodies deflect so far at rest that nothing is known of their inertia; take bases with "
        "a "
        "smaller tolerance, or stiffer reference nodes");
  }
  return bounds;
}

}  // namespace sprung::dynamics
