#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body_equations.h"

namespace sprung::test {

/// Momentum of a body and its angular momentum about the world's origin.
struct Momentum {
  Eigen::Vector2d linear = Eigen::Vector2d::Zero();  ///< [kg·m/s]
  double angular = 0.0;                              ///< [kg·m²/s]
};
/// @param q, v  the body's 3+n coordinates and velocities
inline Momentum calc_momentum(const dynamics::Body& body, const Eigen::Ref<const Eigen::VectorXd>& q,
                              const Eigen::Ref<const Eigen::VectorXd>& v) {
  const int size = body.num_coordinates();
  const Eigen::Index n = body.num_modes();
  Eigen::MatrixXd mass(size, size);
  dynamics::calc_mass_matrix(body, dynamics::FrameRotation::from_angle(q[2]), q.tail(n), mass);
  const Eigen::VectorXd conjugate = mass * v;
  // The generalized momentum of θ is the angular momentum about the frame's own origin.
  return {.linear = conjugate.head<2>(), .angular = conjugate[2] + q[0] * conjugate[1] - q[1] * conjugate[0]};
}

}  // namespace sprung::test
