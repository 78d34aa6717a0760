#pragma once

#include <Eigen/Core>

#include "fem/mesh.h"

namespace sprung::fem::test {

/// The three rigid motions of a frame: unit translation along x, along y, unit rotation about a point.
///
/// @param origin  the point [m]
/// @return 3N×3, dof order of AssembledMatrices [-, -, m; rotation in rad]
inline Eigen::MatrixXd calc_rigid_motions(const Mesh& mesh, const Eigen::Vector2d& origin) {
  Eigen::MatrixXd R_rigid = Eigen::MatrixXd::Zero(3 * mesh.num_nodes(), 3);
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Eigen::Vector2d r = mesh.node_positions.col(node) - origin;
    R_rigid(3 * node, 0) = 1.0;
    R_rigid(3 * node + 1, 1) = 1.0;
    R_rigid(3 * node, 2) = -r.y();
    R_rigid(3 * node + 1, 2) = r.x();
    R_rigid(3 * node + 2, 2) = 1.0;
  }
  return R_rigid;
}

}  // namespace sprung::fem::test
