#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

/// Index of the body that never moves.
inline constexpr int kGround = -1;

/// A point of a body, with axes, where joints and forces act and results are asked for. On a flexible body it
/// moves with a node; an offset from the node turns with the node's rotation, so that both together are
/// linear in η.
struct Marker {
  std::string name;  ///< "body.point"
  int body = kGround;
  Eigen::Vector2d p_BP =
      Eigen::Vector2d::Zero();  ///< undeformed position from the body frame's origin, body axes [m]
  double alpha_BP = 0.0;        ///< undeformed angle against the body's axes [rad]
  Eigen::Matrix3Xd Phi;  ///< displacement and rotation per unit modal coordinate, body axes, 3×n [m, m, rad]
  SecondOrder K;         ///< of the point where its body stiffens, else empty

  bool has_second_order() const { return K[0].size() > 0; }
};

/// Motion of a marker, world axes: all that joints and forces see of the vehicle. Members that are read
/// together lie in one cache line: positions and velocities, then the terms of accelerations and gradients.
struct alignas(64) MarkerState {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();        ///< position [m]
  Eigen::Vector2d r_theta = Eigen::Vector2d::Zero();  ///< ∂r/∂θ [m/rad]
  double angle = 0.0;                                 ///< θ, its own, and by the modes [rad]
  double omega = 0.0;                                 ///< angular velocity [rad/s]
  Eigen::Vector2d v = Eigen::Vector2d::Zero();        ///< velocity [m/s]
  Eigen::Vector2d a_bias = Eigen::Vector2d::Zero();   ///< acceleration while q̈ = 0 [m/s²]
  double alpha_bias = 0.0;                            ///< angular acceleration while q̈ = 0 [rad/s²]
  FrameRotation rotation;                             ///< A of its body, where that has modes
  Eigen::Matrix3Xd Phi;  ///< ∂(position in the body, angle)/∂η, 3×n [m, m, rad]

  /// ∂r/∂η, 2×n [m]
  Eigen::Matrix2Xd r_eta() const;
};

/// A row vector that multiplies a marker's motion (δx, δy, δangle), world axes: force and torque, or a row of
/// a joint's Jacobian.
struct MarkerRow {
  double x, y, angle;

  /// (x, y, angle) ∂(r, angle)/∂θ
  double by_theta(const MarkerState& state) const {
    return x * state.r_theta.x() + y * state.r_theta.y() + angle;
  }
  /// The same in the axes of the marker's body.
  MarkerRow in_body(const FrameRotation& A) const {
    return {A.cosine * x + A.sine * y, A.cosine * y - A.sine * x, angle};
  }
  /// In the axes of the body: (x, y, angle) times a column of MarkerState::Phi.
  double by_mode(const double* shape) const { return x * shape[0] + y * shape[1] + angle * shape[2]; }
};

/// A marker's state with room for its gradients, at the marker's position in its body: that of a marker on
/// the ground is complete.
MarkerState make_marker_state(const Marker& marker);

/// Displacement of the marker by the modes of its body, body axes: Φη and the part of second order [m].
/// @param eta  n
Eigen::Vector2d calc_marker_deflection(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta);

/// The parts of a displacement of second order in the two functions below: in the position u in the body, the
/// angle and their gradients; in the acceleration while q̈ = 0.
void add_second_order_position(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta,
                               Eigen::Vector2d& u, MarkerState& state);
void add_second_order_bias(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta_dot,
                           MarkerState& state);

/// Position of a marker that is at u in its deformed body, and its derivative by the body's angle.
/// @param u  body axes [m]   @param q  the body's coordinates, the first two of them
inline void place_in_body(const Eigen::Vector2d& u, const FrameRotation& rotation, const double* q,
                          MarkerState& state) {
  // One number at a time: pairs whose halves have just been written one by one are slow to read.
  const double arm_x = rotation.cosine * u.x() - rotation.sine * u.y();
  const double arm_y = rotation.sine * u.x() + rotation.cosine * u.y();
  state.r = {q[0] + arm_x, q[1] + arm_y};
  state.r_theta = {-arm_y, arm_x};
}

/// Velocity of a marker of a rigid body, after its position.
/// @param v  the body's 3 velocities
inline void move_with_body(const double* v, MarkerState& state) {
  const double omega = v[2];
  state.omega = omega;
  const double across_x = state.r_theta.x() * omega, across_y = state.r_theta.y() * omega;
  state.v = {v[0] + across_x, v[1] + across_y};
  state.a_bias = {-omega * across_y, omega * across_x};
}

/// Position-level part of a marker's state.                                       (bodies, eqs. 1, 11)
/// @param q      the body's 3+n coordinates
/// @param state  made by make_marker_state
inline void calc_marker_position(const Marker& marker, const FrameRotation& rotation, const double* q,
                                 MarkerState& state) {
  const Eigen::Index n = marker.Phi.cols();
  const double* eta = q + 3;
  const double* shape = marker.Phi.data();
  double x = marker.p_BP.x(), y = marker.p_BP.y(), turn = 0.0;
  for (Eigen::Index k = 0; k < n; ++k, shape += 3) {
    x += shape[0] * eta[k];
    y += shape[1] * eta[k];
    turn += shape[2] * eta[k];
  }
  state.rotation = rotation;
  state.angle = q[2] + marker.alpha_BP + turn;
  Eigen::Vector2d u(x, y);
  if (marker.has_second_order()) {
    add_second_order_position(marker, Eigen::Map<const Eigen::VectorXd>(eta, n), u, state);
  }
  place_in_body(u, rotation, q, state);
}

/// Velocity-level part, after calc_marker_position.                               (bodies, eqs. 2, 11)
/// @param v  the body's 3+n velocities
inline void calc_marker_velocity(const Marker& marker, const double* v, MarkerState& state) {
  const Eigen::Index n = marker.Phi.cols();
  const double* eta_dot = v + 3;
  const double* shape = state.Phi.data();
  double x = 0.0, y = 0.0, turn = 0.0;  // u̇, and the rotation that goes with it
  for (Eigen::Index k = 0; k < n; ++k, shape += 3) {
    x += shape[0] * eta_dot[k];
    y += shape[1] * eta_dot[k];
    turn += shape[2] * eta_dot[k];
  }
  const FrameRotation& A = state.rotation;
  const double bending_x = A.cosine * x - A.sine * y, bending_y = A.sine * x + A.cosine * y;
  const double across_x = state.r_theta.x() * v[2], across_y = state.r_theta.y() * v[2];
  state.omega = v[2] + turn;
  state.v = {v[0] + across_x + bending_x, v[1] + across_y + bending_y};
  state.a_bias = {-v[2] * (across_y + 2.0 * bending_y), v[2] * (across_x + 2.0 * bending_x)};
  if (marker.has_second_order())
    add_second_order_bias(marker, Eigen::Map<const Eigen::VectorXd>(eta_dot, n), state);
}

/// Acceleration of a marker, r̈ = ∂r/∂q q̈ + bias [m/s²].
/// @param v_dot  the body's 3+n accelerations
Eigen::Vector2d calc_marker_acceleration(const MarkerState& state,
                                         const Eigen::Ref<const Eigen::VectorXd>& v_dot);

}  // namespace sprung::dynamics
