#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

void calc_marker_position(const Marker& marker, const FrameRotation& rotation,
                          const Eigen::Ref<const Eigen::VectorXd>& q, MarkerState& state) {
  Eigen::Vector2d u = marker.p_BP;
  state.angle = q[2] + marker.alpha_BP;
  for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) {
    const Eigen::Vector2d shape = marker.Phi.col(k);
    u += shape * q[3 + k];
    state.angle += marker.Phi_rotation[k] * q[3 + k];
    state.r_eta.col(k) = rotation * shape;
  }
  const Eigen::Vector2d arm = rotation * u;
  state.r = q.head<2>() + arm;
  state.r_theta = turned(arm);
}

void calc_marker_velocity(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& v, MarkerState& state) {
  Eigen::Vector2d bending = Eigen::Vector2d::Zero();  // A Φ η̇
  state.omega = v[2];
  for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) {
    bending += state.r_eta.col(k) * v[3 + k];
    state.omega += marker.Phi_rotation[k] * v[3 + k];
  }
  state.v = v.head<2>() + state.r_theta * v[2] + bending;
  state.a_bias = v[2] * turned(state.r_theta * v[2] + 2.0 * bending);
}

Eigen::Vector2d calc_marker_acceleration(const MarkerState& state, const Eigen::Ref<const Eigen::VectorXd>& v_dot) {
  Eigen::Vector2d a = state.a_bias + v_dot.head<2>() + state.r_theta * v_dot[2];
  for (Eigen::Index k = 0; k < state.r_eta.cols(); ++k) a += state.r_eta.col(k) * v_dot[3 + k];
  return a;
}

}  // namespace sprung::dynamics
