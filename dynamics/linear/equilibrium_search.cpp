#include "dynamics/linear/equilibrium_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "dynamics/linear/linearisation.h"

namespace sprung::dynamics {

namespace {

constexpr double kPredictionError = 0.1;  // of the change of forces that the stiffness predicts
constexpr double kFastDecrease = 0.3;     // ratio of two successive steps with the same stiffness
constexpr double kFirstDamping = 1e-6;    // of a step, of the largest stiffness
constexpr double kLessDamping = 0.1;      // after a step that descends
constexpr double kWatchedReach = 3.0;     // of the first of the Newton steps that are watched
constexpr int kMostWatched = 12;          // Newton steps until one has to be lower than where they began

Eigen::VectorXd select_independent(const LinearisedSystem& system, const Eigen::VectorXd& q) {
  Eigen::VectorXd q_i(static_cast<Eigen::Index>(system.partition.independent.size()));
  for (Eigen::Index k = 0; k < q_i.size(); ++k)
    q_i[k] = q[system.partition.independent[static_cast<std::size_t>(k)]];
  return q_i;
}

// Ends a watch that has come lower. @return whether it has lasted too long, or has come too far: there may be
// another equilibrium
bool has_failed(const Model& model, const Eigen::VectorXd& q, Search& search, double potential,
                double force) {
  if (!search.watch) return false;
  if (potential < search.watch->potential || force < search.watch->force) {
    search.watch.reset();
    search.next_wait = 1;
    return false;
  }
  return model.largest_natural(q - search.watch->q) > search.watch->reach || search.watch->steps_left-- == 0;
}

Eigen::VectorXd return_to_watch(const ModalForce& modal, Search& search) {
  Eigen::VectorXd q = std::move(search.watch->q);
  search.watch.reset();
  search.damping = kFirstDamping * modal.stiffest;
  search.wait = search.next_wait;
  search.next_wait *= 2;
  return q;
}

}  // namespace

Eigen::VectorXd take_step(const Model& model, PartitionedEquations& equations, const LinearisedSystem& system,
                          const ModalForce& modal, const Eigen::VectorXd& q, const SteadyMotion& motion,
                          Search& search) {
  const Eigen::VectorXd q_i = select_independent(system, q);
  const double force = modal.force.norm();
  double potential = 0.0;
  calc_static_force(equations, 0.0, q_i, &potential, motion);
  if (has_failed(model, q, search, potential, force)) return return_to_watch(modal, search);
  const Eigen::MatrixXd& V = modal.modes.vectors;
  for (int attempt = 0; attempt < 40; ++attempt) {
    const bool is_newton = attempt == 0 && search.wait == 0 && modal.is_held();
    const double damping = is_newton ? 0.0 : search.damping;
    Eigen::VectorXd step = modal.calc_step(modal.force, damping);
    const double size = largest_natural(model, system.partition.independent, step);
    const bool is_cut = size > search.reach;
    if (is_cut) step *= search.reach / size;
    double trial_potential = 0.0;
    const Eigen::VectorXd trial_force =
        calc_static_force(equations, 0.0, q_i + step, &trial_potential, motion);
    const bool assembled = trial_force.size() == q_i.size();
    bool is_predicted = false;
    if (assembled && !modal.is_falling) {
      const Eigen::VectorXd change = V.transpose() * (system.stiffness * step),
                            error = V.transpose() * (trial_force - system.force) + change;
      is_predicted = error.norm() < kPredictionError * change.norm();
    }
    // Beside a maximum of the potential energy rounding hides how it decreases, but not the work of the
    // forces.
    const bool leaves_maximum =
        is_predicted && !modal.is_held() && step.dot(system.force + trial_force) > 0.0;
    if (assembled &&
        (trial_potential < potential || leaves_maximum || (V.transpose() * trial_force).norm() < force)) {
      search.reach = is_cut && is_predicted ? 2.0 * search.reach : kLargestStep;
      search.damping = kLessDamping * damping;
      search.wait = std::max(0, search.wait - 1);
      break;
    }
    if (is_newton && !is_cut && assembled && trial_force.allFinite()) {
      if (!search.watch) search.watch = Watch{q, potential, force, kWatchedReach * size, kMostWatched};
      break;
    }
    search.damping = std::max(10.0 * search.damping, kFirstDamping * modal.stiffest);
    search.reach = kLargestStep;
  }
  return equations.q();
}

Eigen::VectorXd iterate_with_same_stiffness(const Model& model, PartitionedEquations& equations,
                                            const LinearisedSystem& system, const ModalForce& modal,
                                            const SteadyMotion& motion, double last_size, double tolerance,
                                            int& steps) {
  const auto calc_force = [&](const Eigen::VectorXd& q_i) -> std::optional<Eigen::VectorXd> {
    Eigen::VectorXd force = calc_static_force(equations, 0.0, q_i, nullptr, motion);
    if (force.size() == 0 || !force.allFinite()) return std::nullopt;
    return force;
  };
  while (last_size > tolerance) {
    Eigen::VectorXd good = equations.q();
    Eigen::VectorXd q_i = select_independent(system, good);
    const auto force = calc_force(q_i);
    if (!force) return good;
    const Eigen::VectorXd step = modal.calc_step(modal.modes.vectors.transpose() * *force, 0.0);
    const double size = largest_natural(model, system.partition.independent, step);
    if (!(size < kFastDecrease * last_size)) break;
    good = equations.q();
    q_i += step;
    if (!calc_force(q_i)) return good;
    ++steps;
    last_size = size;
  }
  return equations.q();
}

}  // namespace sprung::dynamics
