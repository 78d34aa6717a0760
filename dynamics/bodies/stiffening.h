#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Displacement of second order of a point: ½ ηᵀ(K_x, K_y, K_angle)η is subtracted from its displacement
/// along x and y and from its rotation, body axes. Each is n×n and symmetric; all are empty where there is
/// none.
using SecondOrder = std::array<Eigen::MatrixXd, 3>;

/// The effect of axial forces on the bending of a body, from the geometric stiffness of its superelement
/// (bodies, eqs. 7–12). n active modes.
struct BodyStiffening {
  Eigen::MatrixXd centrifugal;       ///< K_ω about the centre of mass, n×n
  Eigen::RowVectorXd mean_rotation;  ///< ĉ: the body turns at θ̇ + ĉ η̇ in the mean, 1×n
  SecondOrder origin;                ///< of the material point at the origin of the undeformed body
};

/// @param columns  0-based active modes, each below superelement.geometric_stiffness->num_modes()
BodyStiffening make_body_stiffening(const reduce::Superelement& superelement,
                                    const std::vector<int>& columns);

/// Displacement of second order of a point fixed to a named node.                    (bodies, eqs. 9, 10)
/// @param point   0-based, of superelement.points
/// @param offset  of the point from the node, body axes [m]
SecondOrder calc_second_order(const reduce::Superelement& superelement, const std::vector<int>& columns,
                              const BodyStiffening& stiffening, int point, const Eigen::Vector2d& offset);

/// ½ ηᵀ(K_x, K_y, K_angle)η.
Eigen::Vector3d calc_half_form(const SecondOrder& K, const Eigen::Ref<const Eigen::VectorXd>& eta);

/// Forces by which turning stiffens a body; they do no work.                           (bodies, eq. 12)
/// @param theta_dot [rad/s]; eta, eta_dot n; Q 3+n, added to
void add_stiffening_forces(const BodyStiffening& stiffening, double theta_dot,
                           const Eigen::Ref<const Eigen::VectorXd>& eta,
                           const Eigen::Ref<const Eigen::VectorXd>& eta_dot, Eigen::Ref<Eigen::VectorXd> Q);

}  // namespace sprung::dynamics
