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

}  // namespace sprung::dynamics
