#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body_mass.h"

namespace sprung::test {

/// Momentum of a body and its angular momentum about the world's origin.
struct Momentum {
  Eigen::Vector2d linear = Eigen::Vector2d::Zero();  ///< [kg·m/s]
  double angular = 0.0;                              ///< [kg·m²/s]
};
/// @param q, v  the body's 3+n coordinates and velocities
inline Momentum calc_momentum(const dynamics::Body& body, const Eigen::Ref<const Eigen::VectorXd>& q,
                              const Eigen::Ref<const Eigen::VectorXd>& v) {
  dynamics::BodyMass mass(body);
  mass.update(dynamics::FrameRotation::from_angle(q[2]), q.tail(body.num_modes()));
  const Eigen::VectorXd conjugate = mass.matrix() * v;
  // The generalized momentum of θ is the angular momentum about the frame's own origin.
  return {.linear = conjugate.head<2>(), .angular = conjugate[2] + q[0] * conjugate[1] - q[1] * conjugate[0]};
}

}  // namespace sprung::test
