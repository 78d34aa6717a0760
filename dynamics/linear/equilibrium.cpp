#include "dynamics/linear/equilibrium.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "dynamics/linear/frequency_solver.h"
#include "dynamics/linear/undamped_modes.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxNewtonIterations = 200;
constexpr double kRoundingStep = 1e-10;    // steps below this that stop decreasing are rounding
constexpr double kWorstRounding = 1e-5;    // largest rounding of a step that is accepted
constexpr double kRoundingMargin = 4.0;    // the estimate of rounding is correct to a factor of a few
constexpr double kStiffestHz = 1e7;        // no vehicle has a faster mode: its stiffness or mass is mistaken
constexpr double kPushedStiffness = 1e-9;  // for a direction with force and no stiffness, of the largest one
constexpr double kNeutralForce = 1e-7;     // acceleration along a neutral direction, natural sizes/s²
constexpr double kLargestStep = 0.05;      // natural sizes per iteration, at first
constexpr double kPredictionError = 0.1;   // of the change of forces that the stiffness predicts
constexpr double kFastDecrease = 0.3;      // ratio of two successive steps with the same stiffness
constexpr double kFirstDamping = 1e-6;     // of a step, of the largest stiffness
constexpr double kLessDamping = 0.1;       // after a step that descends
constexpr double kWatchedReach = 3.0;      // of the first of the Newton steps that are watched
constexpr int kMostWatched = 12;           // Newton steps until one has to be lower than where they began

double largest_natural(const Model& model, const std::vector<int>& coordinates,
                       const Eigen::VectorXd& values) {
  double largest = 0.0;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    largest = std::max(
        largest, std::abs(values[static_cast<Eigen::Index>(k)]) / model.coordinate_scale(coordinates[k]));
  }
  return largest;
}

// The linearised system in its own modes: mass-normalised shapes V, stiffness-to-mass ratios ω², forces r.
struct ModalForce {
  UndampedModes modes;
  Eigen::VectorXd force;
  double stiffest = 0.0;  // largest |ω²|, or more where the forces would cause steps above kLargestStep
  double rounding_step = 0.0;    // the step that rounding of the forces causes [natural sizes]
  std::vector<bool> is_neutral;  // without stiffness and without force: keeps its value
  bool is_falling = false;       // some direction has a force, but no stiffness

  ModalForce(const Model& model, const LinearisedSystem& system)
      : modes(calc_undamped_modes(system.stiffness, system.mass, system.stiffness_rounding)) {
    const Eigen::MatrixXd& V = modes.vectors;
    const std::vector<int>& independent = system.partition.independent;
    force = V.transpose() * system.force;
    const Eigen::VectorXd rounding = V.cwiseAbs().transpose() * system.force_rounding;
    const double largest_acceleration = largest_natural(model, independent, V * force);
    stiffest = std::max(modes.omega_squared.cwiseAbs().maxCoeff(), largest_acceleration / kLargestStep);
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(force.size());
    for (Eigen::Index k = 0; k < force.size(); ++k) {
      const double push = std::max(std::abs(force[k]) - rounding[k], 0.0);
      const bool is_pushed = largest_natural(model, independent, V.col(k) * push) > kNeutralForce;
      is_neutral.push_back(modes.is_free(k) && !is_pushed);
      is_falling |= modes.is_free(k) && is_pushed;
      if (!is_neutral.back()) moved += V.col(k).cwiseAbs() * (rounding[k] / calc_stiffness(k));
    }
    rounding_step = kRoundingMargin * largest_natural(model, independent, moved);
  }

  // Whether each direction has a stiffness that holds it, or neither that nor a force.
  bool is_held() const {
    for (Eigen::Index k = 0; k < force.size(); ++k) {
      if (!is_neutral[static_cast<std::size_t>(k)] && modes.omega_squared[k] < 0.0) return false;
    }
    return !is_falling;
  }

  double calc_stiffness(Eigen::Index k) const {
    return modes.is_free(k) ? kPushedStiffness * stiffest : std::abs(modes.omega_squared[k]);
  }

  // Descent step under forces r, with `damping` added to each direction's stiffness; zero along neutral ones.
  Eigen::VectorXd calc_step(const Eigen::VectorXd& r, double damping) const {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(r.size());
    for (Eigen::Index k = 0; k < force.size(); ++k) {
      if (is_neutral[static_cast<std::size_t>(k)]) continue;
      step += modes.vectors.col(k) * (r[k] / (calc_stiffness(k) + damping));
    }
    return step;
  }
};

bool is_stable(const LinearisedSystem& system) {
  const FrequencySolver solver(system.mass, system.damping, system.stiffness, system.stiffness_rounding);
  return !has_growth(solver.eigenvalues());
}

// Whether it is more than a change of internal states.
bool moves_bodies(const Model& model, const Eigen::VectorXd& direction) {
  return !direction.head(model.first_state()).isZero(0.0);
}

NeutralDirection describe(const Model& model, Eigen::VectorXd direction) {
  NeutralDirection neutral;
  std::vector<std::string> moving;
  double largest = 0.0;
  for (int i = 0; i < model.num_coordinates; ++i) {
    largest = std::max(largest, std::abs(direction[i]) / model.coordinate_scale(i));
  }
  direction /= largest;
  const double sign = [&] {
    Eigen::Index i = 0;
    direction.cwiseAbs().maxCoeff(&i);
    return direction[i] < 0.0 ? -1.0 : 1.0;
  }();
  neutral.direction = sign * direction;
  for (int axis = 0; axis < 2; ++axis) {
    bool translation = true;
    for (int i = 0; i < model.num_coordinates; ++i) {
      const bool along = model.body_coordinate(i).local == axis;
      translation &= std::abs(neutral.direction[i] / model.coordinate_scale(i) - (along ? 1.0 : 0.0)) < 1e-4;
    }
    if (translation) {
      neutral.description = fmt::format("all bodies along {}", axis == 0 ? "x" : "y");
      return neutral;
    }
  }
  for (int i = 0; i < model.num_coordinates; ++i) {
    if (std::abs(neutral.direction[i]) / model.coordinate_scale(i) > 0.1)
      moving.push_back(model.coordinate_name(i));
  }
  neutral.description = fmt::format("{}", fmt::join(moving, ", "));
  return neutral;
}

[[noreturn]] void throw_no_equilibrium(const Model& model, const LinearisedSystem& system,
                                       const ModalForce& modal, double last_step) {
  const double least = std::max(modal.rounding_step, Equilibrium::kTolerance);
  Eigen::Index stiffest = 0;
  const double fastest =
      std::sqrt(modal.modes.omega_squared.cwiseAbs().maxCoeff(&stiffest)) / (2.0 * std::numbers::pi);
  if (fastest > kStiffestHz) {
    throw support::NumericalError(fmt::format(
        "no static equilibrium: a stiffness is too large for the mass that it holds, {:.3g} Hz ({}), and its "
        "rounding hides the other forces; make it smaller, or put a joint in its place",
        fastest, describe(model, system.directions * modal.modes.vectors.col(stiffest)).description));
  }
  if (!modal.is_falling && modal.rounding_step > kWorstRounding) {
    throw support::NumericalError(fmt::format(
        "no static equilibrium: rounding beside the largest stiffness, of a mode at {:.3g} Hz, causes steps "
        "of up to {:.1e} of the natural size; take fewer of the highest modes",
        std::sqrt(modal.stiffest) / (2.0 * std::numbers::pi), modal.rounding_step));
  }
  Eigen::Index worst = 0;
  modal.force.cwiseAbs().maxCoeff(&worst);
  const NeutralDirection direction = describe(model, system.directions * modal.modes.vectors.col(worst));
  throw support::NumericalError(
      fmt::format("no static equilibrium after {} iterations: the last step was {:.3g} of the natural size "
                  "(tolerance {:.0e}); what keeps moving: {}; check that something holds it against "
                  "gravity, and the start position",
                  kMaxNewtonIterations, last_step, least, direction.description));
}

Eigen::VectorXd select_independent(const LinearisedSystem& system, const Eigen::VectorXd& q) {
  Eigen::VectorXd q_i(static_cast<Eigen::Index>(system.partition.independent.size()));
  for (Eigen::Index k = 0; k < q_i.size(); ++k)
    q_i[k] = q[system.partition.independent[static_cast<std::size_t>(k)]];
  return q_i;
}

// A position from which Newton steps are taken although neither potential energy nor forces decrease at
// first.
struct Watch {
  Eigen::VectorXd q;  // nq
  double potential, force;
  double reach;  // how far from there the steps may lead [natural sizes]
  int steps_left;
};

// The search for a balance. The bounds of a step widen each time the forces change as the stiffness predicts.
struct Search {
  double damping = 0.0;  // added to the stiffness of each direction
  double reach = kLargestStep;
  std::optional<Watch> watch;
  int wait = 0, next_wait = 1;  // steps downhill until the next watch, and after its failure
};

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
  double distance = 0.0;
  for (int i = 0; i < model.num_coordinates; ++i)
    distance = std::max(distance, std::abs(q[i] - search.watch->q[i]) / model.coordinate_scale(i));
  return distance > search.watch->reach || search.watch->steps_left-- == 0;
}

Eigen::VectorXd return_to_watch(const ModalForce& modal, Search& search) {
  Eigen::VectorXd q = std::move(search.watch->q);
  search.watch.reset();
  search.damping = kFirstDamping * modal.stiffest;
  search.wait = search.next_wait;
  search.next_wait *= 2;
  return q;
}

// One step from the positions where `system` stands: downhill, so that the potential energy decreases or the
// forces do, or a whole Newton step under watch. A beam that bends is a narrow curved valley, whose walls are
// its axial stiffness: a step along the valley runs up the wall, and the next Newton step comes down to its
// floor, far beyond any step that only descends.
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
    if (assembled && (trial_potential < potential || (V.transpose() * trial_force).norm() < force)) {
      const Eigen::VectorXd change = V.transpose() * (system.stiffness * step),
                            error = V.transpose() * (trial_force - system.force) + change;
      const bool is_predicted = !modal.is_falling && error.norm() < kPredictionError * change.norm();
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

// Further steps after a Newton step, with the same stiffness, as long as they decrease fast. Each costs one
// evaluation; a new stiffness costs four for each freedom.
// @param[in,out] steps  number of steps taken   @return positions
Eigen::VectorXd iterate_with_same_stiffness(const Model& model, PartitionedEquations& equations,
                                            const LinearisedSystem& system, const ModalForce& modal,
                                            const SteadyMotion& motion, double last_size, int& steps) {
  while (last_size > Equilibrium::kTolerance) {
    Eigen::VectorXd q_i = select_independent(system, equations.q());
    const Eigen::VectorXd force = calc_static_force(equations, 0.0, q_i, nullptr, motion);
    if (force.size() == 0) break;
    const Eigen::VectorXd step = modal.calc_step(modal.modes.vectors.transpose() * force, 0.0);
    const double size = largest_natural(model, system.partition.independent, step);
    if (!(size < kFastDecrease * last_size)) break;
    q_i += step;
    if (calc_static_force(equations, 0.0, q_i, nullptr, motion).size() == 0) break;
    ++steps;
    last_size = size;
  }
  return equations.q();
}

}  // namespace

Equilibrium find_equilibrium(const Model& model, const Eigen::VectorXd& q,
                             const std::function<void(int, double)>& on_iteration,
                             const SteadyMotion& motion) {
  PartitionedEquations equations(model);
  Equilibrium equilibrium;
  equilibrium.q = q;
  equilibrium.motion = motion;
  if (model.num_freedoms() == 0) {  // the constraints determine all positions
    equations.choose_partition_at(0.0, q);
    equilibrium.linearised.partition = equations.partition();
    return equilibrium;
  }
  Search search;
  double last_step = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    LinearisedSystem system = linearise(equations, 0.0, equilibrium.q, motion);
    equilibrium.q = equations.q();
    const ModalForce modal(model, system);
    const double newton_step =
        largest_natural(model, system.partition.independent, modal.calc_step(modal.force, 0.0));
    if (on_iteration) on_iteration(iteration, newton_step);
    const double rounding = std::clamp(modal.rounding_step, kRoundingStep, kWorstRounding);
    const bool is_rounding = newton_step <= rounding && newton_step > 0.5 * last_step;
    last_step = newton_step;
    if (!modal.is_falling && (newton_step <= Equilibrium::kTolerance || is_rounding)) {
      equilibrium.last_step = newton_step;
      equilibrium.rounding_step = modal.rounding_step;
      for (Eigen::Index k = 0; k < modal.force.size(); ++k) {
        if (modal.is_neutral[static_cast<std::size_t>(k)]) {
          const Eigen::VectorXd direction = system.directions * modal.modes.vectors.col(k);
          if (moves_bodies(model, direction)) equilibrium.neutral.push_back(describe(model, direction));
        } else if (modal.modes.omega_squared[k] < 0.0) {
          equilibrium.stable = false;
        }
      }
      // Coriolis forces may stabilise a rotating system that has a direction of negative stiffness.
      if (motion.omega != 0.0) equilibrium.stable = is_stable(system);
      equilibrium.linearised = std::move(system);
      return equilibrium;
    }
    if (iteration == kMaxNewtonIterations) throw_no_equilibrium(model, system, modal, newton_step);
    equilibrium.q = take_step(model, equations, system, modal, equilibrium.q, motion, search);
    ++equilibrium.iterations;
    if (search.damping == 0.0 && !search.watch && newton_step < kLargestStep && !modal.is_falling) {
      equilibrium.q = iterate_with_same_stiffness(model, equations, system, modal, motion, newton_step,
                                                  equilibrium.iterations);
    }
  }
}

}  // namespace sprung::dynamics
