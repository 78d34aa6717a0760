#include "dynamics/bodies/body_equations.h"

#include <cmath>

namespace sprung::dynamics {

FrameRotation FrameRotation::from_angle(double theta) {
  return {std::cos(theta), std::sin(theta)};
}

FrameRotation NearbyRotation::keep(double theta) {
  kept_angle_ = theta;
  kept_ = FrameRotation::from_angle(theta);
  return kept_;
}

Eigen::Vector2d calc_first_moment(const Body& body, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  Eigen::Vector2d moment = body.first_moment;
  for (int k = 0; k < body.num_modes(); ++k) moment += body.P.col(k) * eta[k];
  return moment;
}

void calc_mass_matrix(const Body& body, const FrameRotation& rotation,
                      const Eigen::Ref<const Eigen::VectorXd>& eta, Eigen::Ref<Eigen::MatrixXd> mass) {
  mass(0, 0) = mass(1, 1) = body.mass;
  mass(0, 1) = mass(1, 0) = 0.0;
  mass.bottomRightCorner(body.num_modes(), body.num_modes()) = body.M_ff;
  update_mass_matrix(body, rotation, eta, mass);
}

void update_mass_matrix(const Body& body, const FrameRotation& rotation,
                        const Eigen::Ref<const Eigen::VectorXd>& eta, Eigen::Ref<Eigen::MatrixXd> mass) {
  const int n = body.num_modes();
  const Eigen::Vector2d M_R_theta = rotation * turned(calc_first_moment(body, eta));
  mass(0, 2) = mass(2, 0) = M_R_theta.x();
  mass(1, 2) = mass(2, 1) = M_R_theta.y();
  double inertia = body.second_moment;
  for (int j = 0; j < n; ++j) {
    const Eigen::Vector2d M_R_eta = rotation * Eigen::Vector2d(body.P.col(j));
    mass(0, 3 + j) = mass(3 + j, 0) = M_R_eta.x();
    mass(1, 3 + j) = mass(3 + j, 1) = M_R_eta.y();
    double M_theta_eta = body.c[j];
    double M_tt_eta = 0.0;
    for (int i = 0; i < n; ++i) {
      M_theta_eta += eta[i] * body.B(i, j);
      M_tt_eta += body.M_tt(i, j) * eta[i];
    }
    mass(2, 3 + j) = mass(3 + j, 2) = M_theta_eta;
    inertia += (2.0 * body.d[j] + M_tt_eta) * eta[j];
  }
  mass(2, 2) = inertia;
}

void add_quadratic_velocity_forces(const Body& body, const FrameRotation& rotation, double theta_dot,
                                   const Eigen::Ref<const Eigen::VectorXd>& eta,
                                   const Eigen::Ref<const Eigen::VectorXd>& eta_dot,
                                   Eigen::Ref<Eigen::VectorXd> Q) {
  const int n = body.num_modes();
  const double theta_dot_squared = theta_dot * theta_dot;
  Eigen::Vector2d along = theta_dot_squared * calc_first_moment(body, eta);
  double about = 0.0;
  for (int j = 0; j < n; ++j) {
    along -= 2.0 * theta_dot * eta_dot[j] * turned(body.P.col(j));
    double M_tt_eta = 0.0;
    double B_eta_dot = 0.0;
    for (int i = 0; i < n; ++i) {
      M_tt_eta += body.M_tt(i, j) * eta[i];
      B_eta_dot -= body.B(i, j) * eta_dot[i];  // B is skew
    }
    about -= 2.0 * theta_dot * (body.d[j] + M_tt_eta) * eta_dot[j];
    Q[3 + j] += theta_dot_squared * (body.d[j] + M_tt_eta) + 2.0 * theta_dot * B_eta_dot;
  }
  Q.head<2>() += rotation * along;
  Q[2] += about;
}

void add_gravity_forces(const Body& body, const FrameRotation& rotation, const Eigen::Vector2d& gravity,
                        const Eigen::Ref<const Eigen::VectorXd>& eta, Eigen::Ref<Eigen::VectorXd> Q) {
  const Eigen::Vector2d gravity_B = rotation.transposed_times(gravity);
  Q.head<2>() += body.mass * gravity;
  Q[2] += turned(calc_first_moment(body, eta)).dot(gravity_B);
  for (int j = 0; j < body.num_modes(); ++j) Q[3 + j] += body.P.col(j).dot(gravity_B);
}

}  // namespace sprung::dynamics
