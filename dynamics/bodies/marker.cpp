#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

Eigen::Matrix2Xd MarkerState::r_eta() const {
  Eigen::Matrix2d A;
  A << rotation.cosine, -rotation.sine, rotation.sine, rotation.cosine;
  return A * Phi.topRows<2>();
}

MarkerState make_marker_state(const Marker& marker) {
  MarkerState state;
  state.r = marker.p_BP;
  state.Phi = marker.Phi;
  return state;
}

Eigen::Vector2d calc_marker_deflection(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta) {
  Eigen::Vector2d deflection = marker.Phi.topRows<2>() * eta;
  if (marker.has_second_order()) deflection -= calc_half_form(marker.K, eta).head<2>();
  return deflection;
}

// The gradient of the second-order displacement is −ηᵀK.
void add_second_order_position(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta,
                               Eigen::Vector2d& u, MarkerState& state) {
  const Eigen::Vector3d back = calc_half_form(marker.K, eta);
  u -= back.head<2>();
  state.angle -= back[2];
  for (Eigen::Index k = 0; k < eta.size(); ++k) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      state.Phi(c, k) = marker.Phi(c, k) - marker.K[static_cast<std::size_t>(c)].col(k).dot(eta);
    }
  }
}

void add_second_order_bias(const Marker& marker, const Eigen::Ref<const Eigen::VectorXd>& eta_dot,
                           MarkerState& state) {
  const Eigen::Vector3d back = 2.0 * calc_half_form(marker.K, eta_dot);
  state.a_bias -= state.rotation * Eigen::Vector2d(back.head<2>());
  state.alpha_bias = -back[2];
}

Eigen::Vector2d calc_marker_acceleration(const MarkerState& state,
                                         const Eigen::Ref<const Eigen::VectorXd>& v_dot) {
  const Eigen::Vector2d bending =
      state.Phi.topRows<2>().lazyProduct(v_dot.tail(state.Phi.cols()));  // body axes
  return state.a_bias + v_dot.head<2>() + state.r_theta * v_dot[2] + state.rotation * bending;
}

}  // namespace sprung::dynamics
