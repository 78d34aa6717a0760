#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

/// Index of the body that never moves.
inline constexpr int kGround = -1;

/// A point of a body, with axes, where joints and forces act and results are asked for. On a flexible body it
/// moves with a node. An offset from the node turns with the node's rotation, to first order, so that the
/// displacement stays linear in η.
struct Marker {
  std::string name;  ///< "body.point"
  int body = kGround;
  Eigen::Vector2d p_BP =
      Eigen::Vector2d::Zero();  ///< undeformed position from the body frame's origin, body axes [m]
  double alpha_BP = 0.0;        ///< undeformed angle against the body's axes [rad]
  Eigen::Matrix3Xd Phi;  ///< displacement and rotation per unit modal coordinate, body axes, 3×n [m, m, rad]
  SecondOrder K;         ///< second-order displacement where axial forces stiffen the body, else empty

  bool has_second_order() const { return K[0].size() > 0; }
};

/// Motion of a marker, world axes: all that joints and forces know of the vehicle. Members that are read
/// together share a cache line: positions and velocities first, then the terms of accelerations and
/// gradients.
struct alignas(64) MarkerState {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();        ///< position [m]
  Eigen::Vector2d r_theta = Eigen::Vector2d::Zero();  ///< ∂r/∂θ [m/rad]
  double angle = 0.0;                                ///< of the body, of the marker in it, of the modes [rad]
  double omega = 0.0;                                ///< angular velocity [rad/s]
  Eigen::Vector2d v = Eigen::Vector2d::Zero();       ///< velocity [m/s]
  Eigen::Vector2d a_bias = Eigen::Vector2d::Zero();  ///< acceleration while q̈ = 0 [m/s²]
  double alpha_bias = 0.0;                           ///< angular acceleration while q̈ = 0 [rad/s²]
  FrameRotation rotation;                            ///< A of its body, if the body has modes
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

/// A marker's state with storage for its gradients. For a marker on the ground the state is complete.
MarkerState make_marker_state(const Marker& marker);

/// Displacement of the marker by the modes of its body, body axes: Φη and the second-order part [m].
/// @param eta  n
/// Checked by tests/dynamics/bodies/marker_test.cpp
Eigen::Vector2d calc_marker_deflection(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta);

/// Contributions of the second-order displacement (bodies, eq. 11): to the position u in the body, the angle
/// and their gradients; to the acceleration while q̈ = 0.
void add_second_order_position(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta,
                               Eigen::Vector2d& u, MarkerState& state);
void add_second_order_bias(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta_dot,
                           MarkerState& state);

/// Sets the position of a marker, and its derivative with respect to the body's angle.
/// @param u  position in the deformed body, body axes [m]
/// @param q  the first two coordinates of the body
inline void place_in_body(const Eigen::Vector2d& u, const FrameRotation& rotation, const double* q,
                          MarkerState& state) {
  // Scalars are read one at a time: a vector load of two scalars that have just been stored singly is slow.
  const double arm_x = rotation.cosine * u.x() - rotation.sine * u.y();
  const double arm_y = rotation.sine * u.x() + rotation.cosine * u.y();
  state.r = {q[0] + arm_x, q[1] + arm_y};
  state.r_theta = {-arm_y, arm_x};
}

/// Sets the velocity of a marker of a rigid body; the position must be up to date.
/// @param v  the body's 3 velocities
inline void move_with_body(const double* v, MarkerState& state) {
  const double omega = v[2];
  state.omega = omega;
  const double across_x = state.r_theta.x() * omega, across_y = state.r_theta.y() * omega;
  state.v = {v[0] + across_x, v[1] + across_y};
  state.a_bias = {-omega * across_y, omega * across_x};
}

/// Φη of a marker: its displacement (x, y, angle) by the modes, body axes. @param eta  n
inline Eigen::Vector3d multiply_shapes(const Eigen::Matrix3Xd& Phi, const double* eta) {
  double x = 0.0, y = 0.0, turn = 0.0;
  const double* shape = Phi.data();
  for (Eigen::Index k = 0; k < Phi.cols(); ++k, shape += 3) {
    x += shape[0] * eta[k];
    y += shape[1] * eta[k];
    turn += shape[2] * eta[k];
  }
  return {x, y, turn};
}

/// Position-level part of the state of a marker on a flexible body.               (bodies, eqs. 1, 11)
/// @param displacement  Φη, 3
/// @param q             the body's 3+n coordinates
/// @param state         made by make_marker_state
inline void place_marker(const Marker& marker, const double* displacement, const FrameRotation& rotation,
                         const double* q, MarkerState& state) {
  state.rotation = rotation;
  state.angle = q[2] + marker.alpha_BP + displacement[2];
  Eigen::Vector2d u(marker.p_BP.x() + displacement[0], marker.p_BP.y() + displacement[1]);
  if (marker.has_second_order()) {
    add_second_order_position(marker, Eigen::Map<const Eigen::VectorXd>(q + 3, marker.Phi.cols()), u, state);
  }
  place_in_body(u, rotation, q, state);
}

/// The same for a marker by itself, on any body.
/// Checked by tests/dynamics/bodies/marker_test.cpp
inline void calc_marker_position(const Marker& marker, const FrameRotation& rotation, const double* q,
                                 MarkerState& state) {
  place_marker(marker, multiply_shapes(marker.Phi, q + 3).data(), rotation, q, state);
}

/// Velocity-level part of the state of a marker on a flexible body, after its position, without the
/// second-order bias.                                                            (bodies, eqs. 2, 11)
/// @param rate  3: u̇ and the angular velocity due to the modes, body axes
/// @param v     the body's 3+n velocities
inline void move_marker(const double* rate, const double* v, MarkerState& state) {
  const FrameRotation& A = state.rotation;
  const double bending_x = A.cosine * rate[0] - A.sine * rate[1],
               bending_y = A.sine * rate[0] + A.cosine * rate[1];
  const double across_x = state.r_theta.x() * v[2], across_y = state.r_theta.y() * v[2];
  state.omega = v[2] + rate[2];
  state.v = {v[0] + across_x + bending_x, v[1] + across_y + bending_y};
  state.a_bias = {-v[2] * (across_y + 2.0 * bending_y), v[2] * (across_x + 2.0 * bending_x)};
}

/// The same for a marker by itself, on any body, after calc_marker_position.
/// Checked by tests/dynamics/bodies/marker_test.cpp
inline void calc_marker_velocity(const Marker& marker, const double* v, MarkerState& state) {
  move_marker(multiply_shapes(state.Phi, v + 3).data(), v, state);
  if (marker.has_second_order())
    add_second_order_bias(marker, Eigen::Map<const Eigen::VectorXd>(v + 3, marker.Phi.cols()), state);
}

/// Acceleration of a marker, r̈ = ∂r/∂q q̈ + bias [m/s²].
/// @param v_dot  the body's 3+n accelerations
/// Checked by tests/dynamics/bodies/marker_test.cpp
Eigen::Vector2d calc_marker_acceleration(const MarkerState& state,
                                         const Eigen::Ref<const Eigen::VectorXd>& v_dot);

}  // namespace sprung::dynamics
