#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body_mass.h"
#include "dynamics/bodies/modal_matrix.h"

namespace sprung::dynamics {

/// The forces that act within a body: quadratic velocity forces, weight, stiffness and damping of its modes,
/// and the effect of axial forces where it is switched on (bodies, eqs. 4, 5, 12). n active modes.
class BodyForces {
 public:
  /// @param body has to outlive this
  explicit BodyForces(const Body& body);

  /// Adds the forces, on the right-hand side M q̈ = Q.
  /// @param mass      of the body, up to date at the same θ and η
  /// @param gravity   in the world [m/s²]
  /// @param q, v      3+n
  /// @param[in,out] Q 3+n
  /// @return power that the damping of the modes dissipates [W]
  /// Source: [Shabana 2013], §5.4, with the invariants of the superelement — checked by
  /// tests/dynamics/bodies/body_equations_test.cpp
  double add(const BodyMass& mass, const FrameRotation& rotation, const Eigen::Vector2d& gravity,
             const double* q, const double* v, double* Q);

 private:
  double add_modal_forces(const double* eta, const double* eta_dot, double* Q);

  const Body* body_;
  ModalMatrix B_, stiffness_, damping_;
  Eigen::VectorXd product_;  // n
};

}  // namespace sprung::dynamics
