#include "dynamics/linear/equilibrium.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "dynamics/linear/equilibrium_search.h"
#include "dynamics/linear/frequency_solver.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxNewtonIterations = 200;
constexpr double kRoundingStep = 1e-10;  // steps below this that stop decreasing are rounding
constexpr double kWorstRounding = 1e-5;  // largest rounding of a step that is accepted
constexpr double kStiffestHz = 1e7;      // no vehicle has a faster mode: its stiffness or mass is mistaken
constexpr double kHidden = 1.0;          // 1/s², rounding of ω² beside which a held motion looks neutral

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
  direction /= model.largest_natural(direction);
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

// @throws support::NumericalError at a stiffness whose rounding hides that of other motions
void require_moderate_stiffness(const Model& model, const LinearisedSystem& system, const ModalForce& modal) {
  Eigen::Index stiffest = 0;
  const double fastest =
      std::sqrt(modal.modes.omega_squared.cwiseAbs().maxCoeff(&stiffest)) / (2.0 * std::numbers::pi);
  if (fastest > kStiffestHz) {
    throw support::NumericalError(fmt::format(
        "no static equilibrium: a stiffness is too large for the mass that it holds, {:.3g} Hz ({}), and its "
        "rounding hides the other forces; make it smaller, or put a joint in its place",
        fastest, describe(model, system.directions * modal.modes.vectors.col(stiffest)).description));
  }
}

// A direction that a force pushes along and no stiffness holds, in words; empty if there is none.
std::string describe_falling(const Model& model, const LinearisedSystem& system, const ModalForce& modal) {
  for (Eigen::Index k = 0; k < modal.force.size(); ++k) {
    if (modal.modes.is_free(k) && !modal.is_neutral[static_cast<std::size_t>(k)])
      return describe(model, system.directions * modal.modes.vectors.col(k)).description;
  }
  return {};
}

// @param falling_at_start  a direction that nothing holds there, or empty
[[noreturn]] void throw_no_equilibrium(const Model& model, const LinearisedSystem& system,
                                       const ModalForce& modal, const SteadyMotion& motion, double last_step,
                                       const std::string& falling_at_start) {
  const double least = std::max(modal.rounding_step, Equilibrium::kTolerance);
  require_moderate_stiffness(model, system, modal);
  const bool is_falling = modal.is_falling || !falling_at_start.empty();
  if (model.has_modes() && !is_falling && modal.rounding_step > kWorstRounding) {
    throw support::NumericalError(fmt::format(
        "no static equilibrium: rounding beside the largest stiffness, of a mode at {:.3g} Hz, causes steps "
        "of up to {:.1e} of the natural size; take fewer of the highest modes",
        std::sqrt(modal.stiffest) / (2.0 * std::numbers::pi), modal.rounding_step));
  }
  Eigen::Index worst = 0;
  modal.force.cwiseAbs().maxCoeff(&worst);
  const NeutralDirection direction = describe(model, system.directions * modal.modes.vectors.col(worst));
  std::string moving = direction.description;
  if (!falling_at_start.empty() && falling_at_start != moving)
    moving += "; what nothing holds at the start position against the forces: " + falling_at_start;
  throw support::NumericalError(fmt::format(
      "no static equilibrium after {} iterations: the last step was {:.3g} of the natural size "
      "(tolerance {:.0e}); what keeps moving: {}; check that something holds it against "
      "{}, and the start position",
      kMaxNewtonIterations, last_step, least, moving,
      motion.is_rest() ? "gravity and applied forces" : "the inertia forces of the steady motion"));
}

}  // namespace

std::vector<std::string> Equilibrium::describe_neutral() const {
  std::vector<std::string> texts;
  for (const NeutralDirection& one : neutral) texts.push_back(one.description);
  return texts;
}

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
  std::string falling_at_start;
  double last_step = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    LinearisedSystem system = linearise(equations, 0.0, equilibrium.q, motion);
    equilibrium.q = equations.q();
    const ModalForce modal(model, system);
    if (iteration == 0) falling_at_start = describe_falling(model, system, modal);
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
          if (modal.modes.rounding[k] > kHidden) require_moderate_stiffness(model, system, modal);
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
    if (iteration == kMaxNewtonIterations) {
      throw_no_equilibrium(model, system, modal, motion, newton_step, falling_at_start);
    }
    equilibrium.q = take_step(model, equations, system, modal, equilibrium.q, motion, search);
    ++equilibrium.iterations;
    if (search.damping == 0.0 && !search.watch && newton_step < kLargestStep && !modal.is_falling) {
      equilibrium.q = iterate_with_same_stiffness(model, equations, system, modal, motion, newton_step,
                                                  Equilibrium::kTolerance, equilibrium.iterations);
    }
  }
}

}  // namespace sprung::dynamics
