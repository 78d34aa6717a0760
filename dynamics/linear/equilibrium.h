#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/linear/linearisation.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// A direction without stiffness and without force.
struct NeutralDirection {
  Eigen::VectorXd direction;  ///< nq, its largest entry is 1 natural size
  std::string description;    ///< "all bodies along x", or the coordinates that move
};

/// A static equilibrium.
struct Equilibrium {
  Eigen::VectorXd q;                      ///< num_coordinates
  std::vector<NeutralDirection> neutral;  ///< held at their start value
  double last_step = 0.0;                 ///< size of the last Newton step [natural sizes]
  double rounding_step = 0.0;             ///< the step that rounding alone may cause (linear, eq. 9)
  int iterations = 0;                     ///< steps taken, each with a new or the previous stiffness
  bool stable = true;                     ///< see `find_equilibrium`
  SteadyMotion motion;          ///< of the frame in which it is an equilibrium; rest for a static one
  LinearisedSystem linearised;  ///< about the equilibrium

  /// Size of the last step that counts as accurate [natural sizes].
  static constexpr double kTolerance = 1e-12;
  bool is_usual() const { return last_step <= kTolerance; }
  std::vector<std::string> describe_neutral() const;
};

/// Static equilibrium reached from q by descent of the potential energy: Newton's method in the modes of the
/// linearised system, with bounded steps. So a vehicle that starts above the road comes to rest on its
/// wheels. Neutral directions keep their start value. The search ends where the last step is below
/// kTolerance, or as small as rounding of the forces allows. The equilibrium is stable if no direction has a
/// negative stiffness; in a rotating frame, if no eigenvalue of the damped system has a positive real part.
/// @param q             assembled positions, num_coordinates
/// @param on_iteration  called with the number of the iteration and the natural size of the Newton step; may
///                      be empty
/// @param motion        equilibrium is sought relative to this steady motion
/// @throws support::NumericalError when there is no equilibrium (the message names the coordinate that keeps
///         moving), or when rounding beside a large stiffness hides it (it names the frequency)
/// Checked by tests/dynamics/linear/equilibrium_test.cpp
Equilibrium find_equilibrium(const Model& model, const Eigen::VectorXd& q,
                             const std::function<void(int, double)>& on_iteration = {},
                             const SteadyMotion& motion = {});

}  // namespace sprung::dynamics
