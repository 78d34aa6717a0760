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

void add_second_order_position(const Marker& marker, const FrameRotation& rotation,
                               const Eigen::Ref<const Eigen::VectorXd>& eta, Eigen::Vector2d& u, MarkerState& state) {
  const Eigen::Vector3d back = calc_half_form(marker.K, eta);
  u -= back.head<2>();
  state.angle -= back[2];
  add_second_order_gradients(marker, rotation, eta, state);
}

void add_second_order_bias(const Marker& marker, const FrameRotation& rotation,
                           const Eigen::Ref<const Eigen::VectorXd>& eta_dot, MarkerState& state) {
  const Eigen::Vector3d back = 2.0 * calc_half_form(marker.K, eta_dot);
  state.a_bias -= rotation * Eigen::Vector2d(back.head<2>());
  state.alpha_bias = -back[2];
}

Eigen::Vector2d calc_marker_acceleration(const MarkerState& state, const Eigen::Ref<const Eigen::VectorXd>& v_dot) {
  Eigen::Vector2d a = state.a_bias + v_dot.head<2>() + state.r_theta * v_dot[2];
  for (Eigen::Index k = 0; k < state.r_eta.cols(); ++k) a += state.r_eta.col(k) * v_dot[3 + k];
  return a;
}

}  // namespace sprung::dynamics
