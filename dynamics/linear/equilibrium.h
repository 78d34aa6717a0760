#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/linear/linearisation.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A direction along which nothing holds the system: moving along it changes no force.
struct NeutralDirection {
  Eigen::VectorXd direction;  ///< nq, largest natural movement 1
  std::string description;    ///< "all bodies along x", or the coordinates that move
};

/// A static equilibrium.
struct Equilibrium {
  Eigen::VectorXd q;                      ///< num_coordinates
  std::vector<NeutralDirection> neutral;  ///< held at their start value
  double last_step = 0.0;                 ///< size of the last Newton step [natural sizes]
  double rounding_step = 0.0;             ///< what rounding alone may make of it (linear, eq. 16)
  int iterations = 0;                     ///< steps taken, each with a new stiffness or the one before
  bool stable = true;                     ///< no direction with negative stiffness
  SteadyMotion motion;                    ///< in which it is one; rest in static balance
  LinearisedSystem linearised;            ///< about it

  /// Usual accuracy: natural sizes of the last step.
  static constexpr double kTolerance = 1e-12;
  bool is_usual() const { return last_step <= kTolerance; }
};

/// Static equilibrium reached from q by following the potential energy downhill (Newton in the modes of the
/// linearised system, with bounded steps), so that a vehicle put down too high comes to rest on its wheels.
/// Neutral directions keep their start value.
/// @param q  assembled positions
/// @param on_iteration  told the number of the iteration and the Newton step's natural size; may be empty
/// @param motion  for the balance of what is carried along by a steady motion
/// The search ends where the last step is below kTolerance, or as small as rounding of the forces allows.
/// @throws support::NumericalError naming the coordinate that keeps moving, when there is no equilibrium, or
/// the stiffness beside which rounding hides it
Equilibrium find_equilibrium(const Model& model, const Eigen::VectorXd& q,
                             const std::function<void(int, double)>& on_iteration = {},
                             const SteadyMotion& motion = {});

}  // namespace sprung::dynamics
