#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Matrices K of a point's second-order displacement: ½ ηᵀ(K_x, K_y, K_angle)η is subtracted from its
/// displacements along x and y and from its rotation, body axes. Each is n×n and symmetric, or empty for
/// none.
using SecondOrder = std::array<Eigen::MatrixXd, 3>;

/// The effect of axial forces on the bending of a body, from the geometric stiffness of its superelement
/// (bodies, eqs. 7–12). n active modes.
struct BodyStiffening {
  Eigen::MatrixXd centrifugal;       ///< K_ω about the centre of mass, n×n
  Eigen::RowVectorXd mean_rotation;  ///< ĉ: the mean angular velocity of the body is θ̇ + ĉ η̇, 1×n
  SecondOrder origin;  ///< K_o, of the material point at the origin of the undeformed body's frame
};

/// The stiffening of a body with some modes of a superelement active.
/// @param columns  0-based active modes, each below superelement.geometric_stiffness->num_modes()
/// Checked by tests/dynamics/bodies/stiffening_test.cpp
BodyStiffening make_body_stiffening(const reduce::Superelement& superelement,
                                    const std::vector<int>& columns);

/// Second-order displacement of a point fixed to a named node.                       (bodies, eqs. 9, 10)
/// @param columns  0-based active modes
/// @param point    0-based, of superelement.points
/// @param offset   of the point from the node, body axes [m]
/// Checked by tests/dynamics/bodies/stiffening_test.cpp
SecondOrder calc_second_order(const reduce::Superelement& superelement, const std::vector<int>& columns,
                              const BodyStiffening& stiffening, int point, const Eigen::Vector2d& offset);

/// ½ ηᵀ(K_x, K_y, K_angle)η.
Eigen::Vector3d calc_half_form(const SecondOrder& K, const Eigen::Ref<const Eigen::VectorXd>& eta);

/// Centrifugal stiffening forces of a rotating body and their gyroscopic term; they do no work.  (bodies, eq.
/// 12)
/// @param theta_dot     angular velocity [rad/s]
/// @param eta, eta_dot  n
/// @param[in,out] Q     3+n, added to
/// Checked by tests/dynamics/bodies/stiffening_test.cpp
void add_stiffening_forces(const BodyStiffening& stiffening, double theta_dot,
                           const Eigen::Ref<const Eigen::VectorXd>& eta,
                           const Eigen::Ref<const Eigen::VectorXd>& eta_dot, Eigen::Ref<Eigen::VectorXd> Q);

}  // namespace sprung::dynamics
