#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

namespace {

// Takes the gradients −ηᵀK of the displacement of second order to those of the first.
void add_second_order_gradients(const Marker& marker, const FrameRotation& rotation,
                                const Eigen::Ref<const Eigen::VectorXd>& eta, MarkerState& state) {
  for (Eigen::Index k = 0; k < eta.size(); ++k) {
    state.r_eta.col(k) -= rotation * Eigen::Vector2d(marker.K[0].col(k).dot(eta), marker.K[1].col(k).dot(eta));
    state.angle_eta[k] -= marker.K[2].col(k).dot(eta);
  }
}

}  // namespace

MarkerState make_marker_state(const Marker& marker) {
  MarkerState state;
  state.r = marker.p_BP;
  state.r_eta = Eigen::Matrix2Xd::Zero(2, marker.Phi.cols());
  state.angle_eta = marker.Phi_rotation;
  return state;
}

Eigen::Vector2d calc_marker_deflection(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  Eigen::Vector2d deflection = marker.Phi * eta;
  if (marker.has_second_order()) deflection -= calc_half_form(marker.K, eta).head<2>();
  return deflection;
}

void calc_marker_position(const Marker& marker, const FrameRotation& rotation,
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
  if (marker.has_second_order()) {
    const auto eta = q.tail(marker.Phi.cols());
    const Eigen::Vector3d back = calc_half_form(marker.K, eta);
    u -= back.head<2>();
    state.angle -= back[2];
    add_second_order_gradients(marker, rotation, eta, state);
  }
  const Eigen::Vector2d arm = rotation * u;
  state.r = q.head<2>() + arm;
  state.r_theta = turned(arm);
}

void calc_marker_velocity(const Marker& marker, const FrameRotation& rotation,
                          const Eigen::Ref<const Eigen::VectorXd>& v, MarkerState& state) {
  Eigen::Vector2d bending = Eigen::Vector2d::Zero();  // A u̇
  state.omega = v[2];
  for (Eigen::Index k = 0; k < marker.Phi.cols(); ++k) {
    bending += state.r_eta.col(k) * v[3 + k];
    state.omega += state.angle_eta[k] * v[3 + k];
  }
  state.v = v.head<2>() + state.r_theta * v[2] + bending;
  state.a_bias = v[2] * turned(state.r_theta * v[2] + 2.0 * bending);
  if (marker.has_second_order()) {
    const Eigen::Vector3d back = 2.0 * calc_half_form(marker.K, v.tail(marker.Phi.cols()));
    state.a_bias -= rotation * Eigen::Vector2d(back.head<2>());
    state.alpha_bias = -back[2];
  }
}

Eigen::Vector2d calc_marker_acceleration(const MarkerState& state, const Eigen::Ref<const Eigen::VectorXd>& v_dot) {
  Eigen::Vector2d a = state.a_bias + v_dot.head<2>() + state.r_theta * v_dot[2];
  for (Eigen::Index k = 0; k < state.r_eta.cols(); ++k) a += state.r_eta.col(k) * v_dot[3 + k];
  return a;
}

}  // namespace sprung::dynamics
