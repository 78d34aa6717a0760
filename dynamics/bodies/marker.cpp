#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

Eigen::Vector2d calc_marker_acceleration(const MarkerState& state, const Eigen::Ref<const Eigen::VectorXd>& v_dot) {
  Eigen::Vector2d a = state.a_bias + v_dot.head<2>() + state.r_theta * v_dot[2];
  for (Eigen::Index k = 0; k < state.r_eta.cols(); ++k) a += state.r_eta.col(k) * v_dot[3 + k];
  return a;
}

}  // namespace sprung::dynamics
