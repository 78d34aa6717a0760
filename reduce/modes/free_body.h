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

/// The problem of a free frame's elastic motion, from that of the frame held at its reference node: its
/// solutions are the free modes, moved rigidly so that they vanish there (reduce/basis, eqs. 1–3).
/// Checked by tests/reduce/modes/free_body_test.cpp
ModalProblem make_free_problem(const ModalProblem& held, const RigidMotions& rigid);

/// What loads do to a free body beside moving it rigidly: the loads with the inertia of the rigid motion that
/// they cause, which are in equilibrium (reduce/basis, eq. 4).
/// @param loads  3N×b   @return (3N−3)×b, without the reference node, where no reaction is left
Eigen::MatrixXd balance_loads(const RigidMotions& rigid, const Eigen::MatrixXd& loads);

/// Shapes that have neither momentum nor angular momentum, from shapes that vanish at the reference node: V =
/// φ + R Θ.
/// @param shapes  3N×n   @return 3N×n
Eigen::MatrixXd remove_momentum(const RigidMotions& rigid, const Eigen::MatrixXd& shapes);

}  // namespace sprung::reduce
