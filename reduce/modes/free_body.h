#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

/// Motions of a frame that does not deform: along x, along y, and rotation about the reference node.
struct RigidMotions {
  int reference_node = 0;   ///< 0-based
  Eigen::MatrixXd shapes;   ///< R, 3N×3
  Eigen::MatrixXd momenta;  ///< M R, 3N×3
  Eigen::Matrix3d mass;     ///< M_r = Rᵀ M R
};

/// @param node_positions  2×N, from the reference node [m]
/// @param mass            3N×3N, of the free frame
RigidMotions calc_rigid_motions(const Eigen::Matrix2Xd& node_positions,
                                const Eigen::SparseMatrix<double>& mass, int reference_node);

/// Q, with which the modal problem of a frame held at its reference node becomes that of its elastic motion
/// when it is free: its solutions are the free modes, moved rigidly so that they vanish at the reference node
/// (reduce/basis, eqs. 1–3).
/// @return n×3, ModalProblem::rigid_share
/// Checked by tests/reduce/modes/free_body_test.cpp
Eigen::MatrixXd calc_rigid_share(const RigidMotions& rigid);

/// What loads do to a free body beside moving it rigidly: the loads with the inertia of the rigid motion that
/// they cause, which are in equilibrium (reduce/basis, eq. 4).
/// @param loads  3N×b   @return (3N−3)×b, without the reference node, where no reaction is left
Eigen::MatrixXd balance_loads(const RigidMotions& rigid, const Eigen::MatrixXd& loads);

/// Shapes that have neither momentum nor angular momentum, from shapes that vanish at the reference node: V =
/// φ + R Θ.
/// @param shapes  3N×n   @return 3N×n
Eigen::MatrixXd remove_momentum(const RigidMotions& rigid, const Eigen::MatrixXd& shapes);

}  // namespace sprung::reduce
