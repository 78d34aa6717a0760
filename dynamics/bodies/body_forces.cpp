#include "dynamics/bodies/body_forces.h"

namespace sprung::dynamics {

BodyForces::BodyForces(const Body& body)
    : body_(&body),
      B_(body.B, body.M_tt.diagonal()),
      stiffness_(body.stiffness, body.stiffness.diagonal()),
      damping_(body.damping, body.damping.diagonal()),
      product_(Eigen::VectorXd::Zero(body.num_modes())) {}

double BodyForces::add(const BodyMass& mass, const FrameRotation& rotation, const Eigen::Vector2d& gravity,
                       const double* q, const double* v, double* Q) {
  const int n = body_->num_modes();
  const double rate = v[2];
  const Eigen::Vector2d gravity_B = rotation.transposed_times(gravity);
  const Eigen::Vector2d& moment = mass.first_moment();
  Eigen::Vector2d bending = Eigen::Vector2d::Zero();  // P η̇
  double about = 0.0;                                 // (d + ηᵀM_tt) η̇
  const double* P = body_->P.data();
  for (int k = 0; k < n; ++k, P += 2) {
    const double change = body_->d[k] + mass.M_tt_eta()[k];
    const double eta_dot = v[3 + k];
    bending += eta_dot * Eigen::Vector2d(P[0], P[1]);
    about += change * eta_dot;
    Q[3 + k] += rate * rate * change + (P[0] * gravity_B.x() + P[1] * gravity_B.y());
  }
  const Eigen::Vector2d along = rotation * (rate * rate * moment - 2.0 * rate * turned(bending));
  Q[0] += along.x() + body_->mass * gravity.x();
  Q[1] += along.y() + body_->mass * gravity.y();
  Q[2] += turned(moment).dot(gravity_B) - 2.0 * rate * about;
  if (!B_.is_zero()) {
    B_.multiply(v + 3, product_.data());
    for (int k = 0; k < n; ++k) Q[3 + k] += 2.0 * rate * product_[k];
  }
  if (body_->stiffening) {
    using Modes = Eigen::Map<const Eigen::VectorXd>;
    add_stiffening_forces(*body_->stiffening, rate, Modes(q + 3, n), Modes(v + 3, n),
                          Eigen::Map<Eigen::VectorXd>(Q, 3 + n));
  }
  return add_modal_forces(q + 3, v + 3, Q + 3);
}

// Stiffness and damping of the modes. @param Q  n   @return dissipated power
double BodyForces::add_modal_forces(const double* eta, const double* eta_dot, double* Q) {
  const int n = body_->num_modes();
  stiffness_.multiply(eta, product_.data());
  for (int k = 0; k < n; ++k) Q[k] -= product_[k];
  damping_.multiply(eta_dot, product_.data());
  double dissipated = 0.0;
  for (int k = 0; k < n; ++k) {
    Q[k] -= product_[k];
    dissipated += product_[k] * eta_dot[k];
  }
  return dissipated;
}

}  // namespace sprung::dynamics
