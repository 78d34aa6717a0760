#include "dynamics/linear/linearisation.h"

#include <fmt/format.h>

#include <algorithm>

#include "dynamics/linear/forces_without_value.h"
#include "dynamics/linear/state_derivatives.h"
#include "dynamics/linear/undamped_modes.h"
#include "dynamics/system/energy.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kClosed = 1e-12;  // of the length scale: how exactly PartitionedEquations closes joints

// Rounding errors of the dependent coordinates: those of the joints that they close, nq.
Eigen::VectorXd calc_coordinate_rounding(const Model& model, const Partition& partition,
                                         const Eigen::VectorXd& q) {
  Eigen::VectorXd rounding = Eigen::VectorXd::Zero(model.num_coordinates);
  const double closed = std::max(kClosed * model.length_scale, model.calc_rounding(q));
  for (const int i : partition.dependent) {
    rounding[i] = closed / model.length_scale * model.coordinate_scale(i);
  }
  return rounding;
}

Eigen::VectorXd select_independent(const PartitionedEquations& equations, const Eigen::VectorXd& x) {
  return x(equations.partition().independent);
}

// DᵀM D ρ̈_i at the state that the equations were last evaluated at, with more generalized forces: of
// DᵀM q̈ = Dᵀ Q, in which Dᵀφ_qᵀ λ = 0, all but the part of q̈ that follows ρ̈_i is brought to the right. About
// rest there is no such part: it is of second order in the velocities, and prescribed motion is held.
// @param forces  Q and the additional ones, nq
Eigen::VectorXd calc_relative_force(const PartitionedEquations& equations, const Eigen::VectorXd& forces,
                                    const SteadyMotion& motion) {
  if (motion.is_rest()) return equations.calc_reduced(forces);
  const Eigen::VectorXd relative =
      select_independent(equations, equations.v_dot()) -
      select_independent(equations,
                         motion.calc_acceleration(equations.terms().model(), equations.q(), equations.v()));
  const Eigen::VectorXd others = equations.v_dot() - equations.calc_free_motion(relative);
  return equations.calc_reduced(forces - equations.apply_mass(others));
}

// By calc_relative_force.
Needed needed_by(const SteadyMotion& motion) {
  return motion.is_rest() ? Needed::kForces : Needed::kAccelerations;
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
  const std::vector<int> branches = equations.terms().find_branches();
  if (equations.update_accelerations(branches) != Outcome::kGood) return {};
  if (potential) {
    const Energy energy = calc_energy(equations.terms(), branches);
    *potential = energy.total() - 2.0 * energy.kinetic;
  }
  Eigen::VectorXd force = calc_relative_force(equations, equations.terms().forces(), motion);
  force.tail(equations.terms().model().num_states()).setZero();
  return force;
}

namespace {

// Adds the stiffness, and the rounding of stiffness and force, to a system that is complete otherwise.
// @param equations  evaluated at rest at q_i
void add_stiffness(PartitionedEquations& equations, double time, const Eigen::VectorXd& q_i,
                   const SteadyMotion& motion, LinearisedSystem& system, Eigen::MatrixXd* spread) {
  const Model& model = equations.terms().model();
  const Eigen::VectorXd q = equations.q(), forces = equations.terms().forces();
  const Eigen::Index f = q_i.size(), n = model.num_coordinates;
  // The reduced force, followed by the forces themselves, whose sizes give its rounding.
  const auto [derivative, steps] = differentiate_by_position(
      equations, time, q_i,
      [&](const PartitionedEquations& at, auto) {
        const Eigen::VectorXd without_modal = at.terms().forces() + apply_modal_stiffness(model, at.q() - q);
        Eigen::VectorXd values(f + n);
        values << calc_relative_force(at, without_modal, motion), without_modal;
        return values;
      },
      motion, needed_by(motion), spread);
  const Eigen::MatrixXd& D = system.directions;
  system.stiffness = D.transpose() * apply_modal_stiffness(model, D) - derivative.topRows(f);
  // Internal states are rates: neither they nor forces depend on the coordinates that belong to them.
  system.stiffness.bottomRows(model.num_states()).setZero();
  system.stiffness.rightCols(model.num_states()).setZero();
  if (spread) spread->conservativeResize(f, f);  // of the reduced force

  const Eigen::MatrixXd sizes = D.cwiseAbs();
  // Rounding errors of the dependent rows of D grow as the smallest pivot that they were solved with falls.
  Eigen::MatrixXd errors = sizes;
  for (const int i : system.partition.dependent)
    errors.row(i) /= std::min(1.0, system.partition.smallest_pivot);
  // All entries of D that joints do not keep at zero have rounding errors in natural sizes, and so does the
  // work of each force. Forces that vanish at q do not at the positions of the differences.
  Eigen::VectorXd scales(n);
  for (int i = 0; i < model.num_coordinates; ++i) scales[i] = model.coordinate_scale(i);
  const Eigen::VectorXd independent_scales = scales(system.partition.independent);
  const Eigen::RowVectorXd by_scale = independent_scales.cwiseInverse().transpose();
  const Eigen::MatrixXd gradient = derivative.bottomRows(n).cwiseAbs();
  const Eigen::VectorXd changes = gradient * independent_scales.cwiseMax(q_i.cwiseAbs());
  const Eigen::MatrixXd pattern = equations.find_pattern_of_directions();
  const auto calc_work = [&](const Eigen::VectorXd& of_forces) -> Eigen::VectorXd {
    return (pattern.transpose() * scales.cwiseProduct(of_forces)).cwiseProduct(by_scale.transpose());
  };
  const Eigen::MatrixXd of_work = calc_work(forces.cwiseAbs() + kPositionStep * changes) * by_scale;
  const Eigen::VectorXd per_step = steps.cwiseInverse();
  const Eigen::MatrixXd of_columns = of_work * per_step.asDiagonal();
  system.stiffness_rounding =
      kRoundingUnit * (sizes.transpose() * (apply_modal_stiffness(model, errors, true) +
                                            Eigen::MatrixXd(gradient * per_step.asDiagonal())) +
                       0.5 * (of_columns + of_columns.transpose()));
  const Eigen::VectorXd moved = calc_coordinate_rounding(model, system.partition, q);
  system.force_rounding = kRoundingUnit * (calc_work(forces.cwiseAbs()) + sizes.transpose() * changes) +
                          sizes.transpose() * apply_modal_stiffness(model, moved, true);
}

}  // namespace

Eigen::MatrixXd calc_reduced_damping(PartitionedEquations& equations, const SteadyMotion& motion) {
  return -differentiate_by_velocity(
      equations,
      [&](const PartitionedEquations& at, auto) {
        return calc_relative_force(at, at.terms().forces(), motion);
      },
      motion, needed_by(motion));
}

namespace {

// @throws support::NumericalError where a force has no value at the positions that were evaluated last
void require_forces(const PartitionedEquations& equations, double time) {
  const std::string elements = describe_forces_without_value(equations.terms().model(), time, equations.q());
  if (elements.empty()) return;
  throw support::NumericalError(
      fmt::format("no force can be calculated for {}, at the start or where the search for the equilibrium "
                  "leads; an air spring, say, has none where no volume is left in it, or where its "
                  "effective_area ends; check what holds the bodies that it joins, and their masses and "
                  "positions",
                  elements));
}

// Without a value of the stiffness, the reason is found among the positions of the differences.
void require_stiffness(PartitionedEquations& equations, double time, const Eigen::VectorXd& q_i,
                       const SteadyMotion& motion, const LinearisedSystem& system) {
  if (system.stiffness.allFinite()) return;
  const Model& model = equations.terms().model();
  for (Eigen::Index k = 0; k < q_i.size(); ++k) {
    const double scale = model.coordinate_scale(system.partition.independent[static_cast<std::size_t>(k)]);
    for (const double steps : {1.0, -1.0, 2.0, -2.0}) {
      const Eigen::VectorXd shift = steps * kPositionStep * scale * Eigen::VectorXd::Unit(q_i.size(), k);
      calc_static_force(equations, time, q_i + shift, nullptr, motion);
      require_forces(equations, time);
    }
  }
  throw support::NumericalError("linearise: the stiffness at the given positions has no value");
}

}  // namespace

LinearisedSystem linearise(PartitionedEquations& equations, double time, const Eigen::VectorXd& q,
                           const SteadyMotion& motion, Eigen::MatrixXd* spread) {
  equations.choose_partition_at(time, q);
  LinearisedSystem system;
  system.partition = equations.partition();
  const Eigen::Index f = equations.num_freedoms();
  Eigen::VectorXd q_i(f);
  for (Eigen::Index k = 0; k < f; ++k) q_i[k] = q[system.partition.independent[static_cast<std::size_t>(k)]];

  system.force = calc_static_force(equations, time, q_i, nullptr, motion);
  if (system.force.size() != f || !system.force.allFinite()) {
    require_forces(equations, time);
    throw support::NumericalError("linearise: the constraints cannot be satisfied at the given positions");
  }
  system.directions = equations.calc_directions();
  system.mass = equations.calc_reduced_mass(system.directions);

  system.damping = calc_reduced_damping(equations, motion);
  calc_static_force(equations, time, q_i, nullptr, motion);
  add_stiffness(equations, time, q_i, motion, system, spread);
  require_stiffness(equations, time, q_i, motion, system);
  calc_static_force(equations, time, q_i, nullptr, motion);
  return system;
}

}  // namespace sprung::dynamics
