#include "dynamics/analysis/linearisation.h"

#include <fmt/format.h>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

// Steps of the differences, of each coordinate's natural size. The error of the extrapolated difference is of the
// order of step⁴, its rounding of 1e-16/step.
constexpr double kPositionStep = 1e-4;
constexpr double kVelocityStep = 1e-3;  // natural sizes per second

std::vector<int> branches_at(const PartitionedEquations& equations) {
  std::vector<int> branches(static_cast<std::size_t>(equations.terms().model().num_branches));
  equations.terms().choose_branches(branches);
  return branches;
}

}  // namespace

Eigen::VectorXd calc_static_force(PartitionedEquations& equations, double time, const Eigen::VectorXd& q_independent,
                                  double* potential) {
  using Outcome = PartitionedEquations::Outcome;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(equations.num_freedoms());
  const auto size = static_cast<std::size_t>(q_independent.size());
  if (equations.update_positions(time, {q_independent.data(), size}) != Outcome::kGood) return {};
  equations.update_velocities({rest.data(), size});
  const std::vector<int> branches = branches_at(equations);
  if (equations.update_accelerations(branches) != Outcome::kGood) return {};
  if (potential) {
    const Energy energy = calc_energy(equations.terms(), branches);
    *potential = energy.total() - energy.kinetic;
  }
  return equations.calc_reduced_force(equations.calc_directions());
}

LinearisedSystem linearise(PartitionedEquations& equations, double time, const Eigen::VectorXd& q) {
  const Model& model = equations.terms().model();
  equations.choose_partition_at(time, q);
  LinearisedSystem system;
  system.partition = equations.partition();
  const Eigen::Index f = equations.num_freedoms();
  Eigen::VectorXd q_i(f);
  for (Eigen::Index k = 0; k < f; ++k) q_i[k] = q[system.partition.independent[static_cast<std::size_t>(k)]];

  system.force = calc_static_force(equations, time, q_i);
  if (system.force.size() != f) {
    throw support::NumericalError("linearise: the constraints cannot be satisfied at the given positions");
  }
  system.directions = equations.calc_directions();
  system.mass = equations.calc_reduced_mass(system.directions);

  // Damping: at fixed positions, the reduced force against the independents' velocities.
  system.damping.resize(f, f);
  const auto force_at_velocity = [&](Eigen::Index k, double value) {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(f);
    v[k] = value;
    equations.update_velocities({v.data(), static_cast<std::size_t>(f)});
    equations.update_accelerations(branches_at(equations));
    return equations.calc_reduced_force(system.directions);
  };
  for (Eigen::Index k = 0; k < f; ++k) {
    const double step =
        kVelocityStep * model.coordinate_scale(system.partition.independent[static_cast<std::size_t>(k)]);
    system.damping.col(k) = -(force_at_velocity(k, step) - force_at_velocity(k, -step)) / (2.0 * step);
  }

  system.stiffness.resize(f, f);
  const auto force_at_position = [&](Eigen::Index k, double shift) {
    Eigen::VectorXd moved = q_i;
    moved[k] += shift;
    Eigen::VectorXd force = calc_static_force(equations, time, moved);
    if (force.size() != f) {
      throw support::NumericalError(fmt::format(
          "linearise: the constraints cannot be satisfied at a distance of {} along {}", shift,
          model.coordinate_name(system.partition.independent[static_cast<std::size_t>(k)])));
    }
    return force;
  };
  for (Eigen::Index k = 0; k < f; ++k) {
    const double h = kPositionStep * model.coordinate_scale(system.partition.independent[static_cast<std::size_t>(k)]);
    const Eigen::VectorXd wide = (force_at_position(k, 2.0 * h) - force_at_position(k, -2.0 * h)) / (4.0 * h);
    const Eigen::VectorXd narrow = (force_at_position(k, h) - force_at_position(k, -h)) / (2.0 * h);
    system.stiffness.col(k) = -(4.0 * narrow - wide) / 3.0;
  }
  calc_static_force(equations, time, q_i);
  return system;
}

}  // namespace sprung::dynamics
