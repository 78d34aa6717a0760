#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body.h"
#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Shapes V of the soft modes of a certificate at a node: x, y and rotation of the free body, 3×q. Zero at
/// freedoms that are neither in the interface nor at the reference node.
Eigen::MatrixXd calc_soft_shapes(const reduce::Superelement& superelement, Eigen::Index node);

/// Stiffness of the soft modes, q: with which they deflect as the true body at rest, and with which they are
/// softer in motion (reduce/certificate, eqs. 8, 9). The same where the file does not say the first.
struct SoftStiffness {
  Eigen::VectorXd at_rest, in_motion;
};
SoftStiffness calc_soft_stiffness(const reduce::Certificate& certificate);

/// Adds the soft modes to a body, in its frame, with their stiffness at rest.
/// @param superelement  of the body, with a certificate
void add_soft_modes(Body& body, const reduce::Superelement& superelement);

/// What is not known of the inertia of the true body when it is deflected, since of what the basis misses
/// only the motion at the interface is known and not that all over the body (bracket, eqs. 1, 2).
struct UnknownInertia {
  double known = 0.0, missed = 0.0;  ///< ‖u‖, ‖u_m‖ of the deflection at rest [m·√kg]
  double radius = 0.0;               ///< √J_c [m·√kg]
  Eigen::MatrixXd elastic_mass;      ///< M_ff − HᵀM_r⁻¹H of its own modes, n×n
};
/// @param body       with its soft modes behind its num_modes own ones
/// @param amplitudes of all of them at rest
UnknownInertia calc_unknown_inertia(const Body& body, Eigen::Index num_modes, const SoftStiffness& stiffness,
                                    const Eigen::VectorXd& amplitudes);

}  // namespace sprung::dynamics
