#include "dynamics/linear/linearisation.h"

#include "dynamics/linear/state_derivatives.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

std::vector<int> branches_at(const PartitionedEquations& equations) {
  std::vector<int> branches(static_cast<std::size_t>(equations.terms().model().num_branches));
  equations.terms().choose_branches(branches);
  return branches;
}

// DᵀM D ρ̈_i at the state evaluated last.
Eigen::VectorXd calc_relative_force(const PartitionedEquations& equations, const Eigen::MatrixXd& directions,
                                    const SteadyMotion& motion) {
  Eigen::VectorXd force = equations.calc_reduced_force(directions);
  if (motion.is_rest()) return force;
  const Eigen::VectorXd carried =
      motion.calc_acceleration(equations.terms().model(), equations.q(), equations.v());
  Eigen::VectorXd independent(force.size());
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    independent[k] = carried[equations.partition().independent[static_cast<std::size_t>(k)]];
  }
  return force - equations.calc_reduced_mass(directions) * independent;
}

}  // namespace

Eigen::VectorXd calc_static_force(PartitionedEquations& equations, double time,
                                  const Eigen::VectorXd& q_independent, double* potential,
                                  const SteadyMotion& motion) {
  using Outcome = PartitionedEquations::Outcome;
  const auto size = static_cast<std::size_t>(q_independent.size());
  if (equations.update_positions(time, {q_independent.data(), size}) != Outcome::kGood) return {};
  const Eigen::VectorXd w = motion.calc_velocity(equations.terms().model(), equations.q());
  Eigen::VectorXd rest(equations.num_freedoms());
  for (Eigen::Index k = 0; k < rest.size(); ++k) {
    rest[k] = w[equations.partition().independent[static_cast<std::size_t>(k)]];
  }
  equations.update_velocities({rest.data(), size});
  const std::vector<int> branches = branches_at(equations);
  if (equations.update_accelerations(branches) != Outcome::kGood) return {};
  if (potential) {
    const Energy energy = calc_energy(equations.terms(), branches);
    *potential = energy.total() - 2.0 * energy.kinetic;
  }
  return calc_relative_force(equations, equations.calc_directions(), motion);
}

LinearisedSystem linearise(PartitionedEquations& equations, double time, const Eigen::VectorXd& q,
                           const SteadyMotion& motion) {
  equations.choose_partition_at(time, q);
  LinearisedSystem system;
  system.partition = equations.partition();
  const Eigen::Index f = equations.num_freedoms();
  Eigen::VectorXd q_i(f);
  for (Eigen::Index k = 0; k < f; ++k) q_i[k] = q[system.partition.independent[static_cast<std::size_t>(k)]];

  system.force = calc_static_force(equations, time, q_i, nullptr, motion);
  if (system.force.size() != f) {
    throw support::NumericalError("linearise: the constraints cannot be satisfied at the given positions");
  }
  system.directions = equations.calc_directions();
  system.mass = equations.calc_reduced_mass(system.directions);

  // At fixed positions the directions are the same; of moved ones they are their own.
  system.damping = -differentiate_by_velocity(
      equations,
      [&](const PartitionedEquations& at, auto) {
        return calc_relative_force(at, system.directions, motion);
      },
      motion);
  system.stiffness = -differentiate_by_position(
      equations, time, q_i,
      [&](const PartitionedEquations& at, auto) {
        return calc_relative_force(at, at.calc_directions(), motion);
      },
      motion);
  calc_static_force(equations, time, q_i, nullptr, motion);
  return system;
}

}  // namespace sprung::dynamics
