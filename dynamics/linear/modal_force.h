#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/linear/linearisation.h"
#include "dynamics/linear/undamped_modes.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The largest step of a search for an equilibrium, at first [natural sizes].
inline constexpr double kLargestStep = 0.05;

/// The largest of some coordinates' values [natural sizes].
double largest_natural(const Model& model, const std::vector<int>& coordinates,
                       const Eigen::VectorXd& values);

/// The linearised system in its own modes: mass-normalised shapes V, stiffness-to-mass ratios ω², forces. f
/// freedoms.
struct ModalForce {
  UndampedModes modes;
  Eigen::VectorXd force;  ///< f
  double stiffest = 0.0;  ///< largest |ω²|, or more where the forces would cause steps above kLargestStep
  double rounding_step = 0.0;    ///< the step that rounding of the forces causes [natural sizes]
  std::vector<bool> is_neutral;  ///< without stiffness and without force: keeps its value
  bool is_falling = false;       ///< some direction has a force, but no stiffness

  ModalForce(const Model& model, const LinearisedSystem& system);
  /// Whether each direction has a stiffness that holds it, or neither that nor a force.
  bool is_held() const;
  double calc_stiffness(Eigen::Index mode) const;  ///< of a direction that is not neutral, > 0
  /// Descent step under forces r, with `damping` added to each direction's stiffness; zero along neutral
  /// ones.
  Eigen::VectorXd calc_step(const Eigen::VectorXd& r, double damping) const;
};

}  // namespace sprung::dynamics
