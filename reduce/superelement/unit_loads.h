#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// A quantity of a body held at its reference node under each of some unit loads (reduce, eqs. 23, 24). In a
/// body that moves freely, loads and inertia are in equilibrium, and the held node carries nothing: the sum
/// over all loads gives the quantity in the moving body. k rows; p named points, n modes.
struct UnitLoads {
  /// Of each of the superelement's points: a force of 1 N on its node along x, along y, a moment of 1 N·m.
  /// k×3p
  Eigen::MatrixXd point_load;
  /// The inertia at an acceleration of the frame of 1 m/s² along x, along y, at an angular acceleration of
  /// 1 rad/s², at an angular velocity of 1 rad/s. k×4
  Eigen::MatrixXd acceleration;
  /// The inertia at an acceleration of each modal coordinate of 1 m·√kg/s². k×n
  Eigen::MatrixXd modal_acceleration;
  /// The same with the accelerations turned by +90°, of points and not of sections. k×n
  Eigen::MatrixXd turned_acceleration;
};

}  // namespace sprung::reduce
