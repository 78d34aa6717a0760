#include "dynamics/analysis/linearisation.h"

#include "dynamics/analysis/state_derivatives.h"
#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

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

  // At fixed positions the directions are the same; of moved ones they are their own.
  system.damping = -differentiate_by_velocity(
      equations, [&](const PartitionedEquations& at, auto) { return at.calc_reduced_force(system.directions); });
  system.stiffness = -differentiate_by_position(equations, time, q_i, [](const PartitionedEquations& at, auto) {
    return at.calc_reduced_force(at.calc_directions());
  });
  calc_static_force(equations, time, q_i);
  return system;
}

}  // namespace sprung::dynamics
