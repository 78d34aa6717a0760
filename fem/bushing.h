#pragma once

#include <Eigen/Core>

namespace sprung::fem {

/// A spring at a point of the line between two nodes, to which it is connected rigidly (fem, eq. 35).
struct Bushing {
  /// against relative displacement and rotation, in the line's own axes; symmetric, positive semidefinite
  /// [N/m, N, N·m]
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  double place = 0.5;  ///< from the first to the second node, 0 … 1
};

/// Stiffness in own axes, freedoms as those of a beam element.
/// @param length  between the nodes, > 0 [m]
/// Checked by tests/reduce/design/foundations_test.py
Eigen::Matrix<double, 6, 6> calc_bushing_stiffness(const Bushing& bushing, double length);

}  // namespace sprung::fem
