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

/// How much the inertia of the true body may differ from that of the body with soft modes, because what is
/// known of them is their motion at the interface and not all over the body (linear, eqs. 18, 19).
struct InertiaMargin {
  double of_rotation = 0.0;   ///< second moment that is added to the body's [kg·m²]
  double of_soft_mode = 0.0;  ///< mass that is added to each soft mode's
  double relative = 0.0;      ///< of all of the body's inertia, more or less
};
/// @param body  with soft modes, whose numbers are above num_modes   @param eta  amplitudes at rest
InertiaMargin calc_inertia_margin(const Body& body, Eigen::Index num_modes, const SoftStiffness& stiffness,
                                  const Eigen::VectorXd& eta);

}  // namespace sprung::dynamics
