#pragma once

#include <Eigen/Core>
#include <string>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

/// Index of the body that never moves.
inline constexpr int kGround = -1;

/// A point of a body, with axes, where joints and forces act and results are asked for. On a flexible body it moves
/// with a node; an offset from the node turns with the node's rotation, so that both together are linear in η.
struct Marker {
  std::string name;                    ///< "body.point"
  int body = kGround;
  Eigen::Vector2d p_BP = Eigen::Vector2d::Zero();  ///< undeformed position from the body frame's origin, body axes [m]
  double alpha_BP = 0.0;               ///< undeformed angle against the body's axes [rad]
  Eigen::Matrix2Xd Phi;                ///< displacement per unit modal coordinate, body axes, 2×n [m]
  Eigen::RowVectorXd Phi_rotation;     ///< rotation per unit modal coordinate, 1×n [rad]
  SecondOrder K;                       ///< of the point where its body stiffens, else empty

  bool has_second_order() const { return K[0].size() > 0; }
};

/// Motion of a marker, world axes; what joints and forces see of the vehicle. What is read together stands
/// together.
struct MarkerState {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();        ///< position [m]
  Eigen::Vector2d r_theta = Eigen::Vector2d::Zero();  ///< ∂r/∂θ [m/rad]
  double angle = 0.0;                                 ///< θ + Φ_rotation η, and of second order [rad]
  double omega = 0.0;                                 ///< angular velocity [rad/s]
  Eigen::Vector2d v = Eigen::Vector2d::Zero();        ///< velocity [m/s]
  Eigen::Vector2d a_bias = Eigen::Vector2d::Zero();   ///< acceleration while q̈ = 0 [m/s²]
  Eigen::Matrix2Xd r_eta;                             ///< ∂r/∂η, 2×n [m]
  Eigen::RowVectorXd angle_eta;                       ///< ∂angle/∂η, 1×n [rad]
  double alpha_bias = 0.0;                            ///< angular acceleration while q̈ = 0 [rad/s²]
};

/// A marker's state with room for its gradients; of a marker on the ground, which stays so, its position too.
MarkerState make_marker_state(const Marker& marker);

/// Displacement of the marker that its body's modes make, body axes: Φη, and of second order [m].
/// @param eta  n
Eigen::Vector2d calc_marker_deflection(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta);

/// What a displacement of second order adds to the two parts below: to the place u in the body, the angle and their
/// gradients; to the acceleration while q̈ = 0.
void add_second_order_position(const Marker& marker, const FrameRotation& rotation,
                               const Eigen::Ref<const Eigen::VectorXd>& eta, Eigen::Vector2d& u, MarkerState& state);
void add_second_order_bias(const Marker& marker, const FrameRotation& rotation,
                           const Eigen::Ref<const Eigen::VectorXd>& eta_dot, MarkerState& state);

/// Position of a marker that is at u in its body, as it is deformed, and the gradient of that by the body's
/// angle.
/// @param u  body axes [m]   @param q  the body's coordinates, the first two of them
inline void place_in_body(const Eigen::Vector2d& u, const FrameRotation& rotation, const double* q,
                          MarkerState& state) {
  // One number at a time: pairs that were just written by their halves are slow to read.
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

/// Position-level part of a marker's state.                                       (dynamics/README.md, eqs. 1, 41)
/// @param q      the body's 3+n coordinates
/// @param state  made by make_marker_state
inline void calc_marker_position(const Marker& marker, const FrameRotation& rotation,
                                 const Eigen::Ref<const Eigen::VectorXd>& q, MarkerState& state) {
  Eigen::Vector2d u = marker.p_BP;
  state.angle = q[2] + marker.alpha_BP;
  for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) {
    const Eigen::Vector2d shape = marker.Phi.col(k);
    u += shape * q[3 + k];
    state.angle += marker.Phi_rotation[k] * q[3 + k];
    state.angle_eta[k] = marker.Phi_rotation[k];
    state.r_eta.col(k) = rotation * shape;
  }
  if (marker.has_second_order()) add_second_order_position(marker, rotation, q.tail(marker.Phi.cols()), u, state);
  place_in_body(u, rotation, q.data(), state);
}

/// Velocity-level part, after calc_marker_position.                               (dynamics/README.md, eqs. 2, 41)
/// @param v  the body's 3+n velocities
inline void calc_marker_velocity(const Marker& marker, const FrameRotation& rotation,
                                 const Eigen::Ref<const Eigen::VectorXd>& v, MarkerState& state) {
  Eigen::Vector2d bending = Eigen::Vector2d::Zero();  // A u̇
  state.omega = v[2];
  for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) {
    bending += state.r_eta.col(k) * v[3 + k];
    state.omega += state.angle_eta[k] * v[3 + k];
  }
  state.v = v.head<2>() + state.r_theta * v[2] + bending;
  state.a_bias = v[2] * turned(state.r_theta * v[2] + 2.0 * bending);
  if (marker.has_second_order()) add_second_order_bias(marker, rotation, v.tail(marker.Phi.cols()), state);
}

/// Acceleration of a marker, r̈ = ∂r/∂q q̈ + bias [m/s²].
/// @param v_dot  the body's 3+n accelerations
Eigen::Vector2d calc_marker_acceleration(const MarkerState& state, const Eigen::Ref<const Eigen::VectorXd>& v_dot);

}  // namespace sprung::dynamics
