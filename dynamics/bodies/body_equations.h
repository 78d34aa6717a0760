#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body.h"

namespace sprung::dynamics {

/// Orientation of a body frame: A = [cos −sin; sin cos], and S = [0 −1; 1 0] turns by +90°.
struct FrameRotation {
  double cosine = 1.0;
  double sine = 0.0;

  static FrameRotation from_angle(double theta);
  Eigen::Vector2d operator*(const Eigen::Vector2d& p_B) const {  ///< A p
    return {cosine * p_B.x() - sine * p_B.y(), sine * p_B.x() + cosine * p_B.y()};
  }
  Eigen::Vector2d transposed_times(const Eigen::Vector2d& p_W) const {  ///< Aᵀ p
    return {cosine * p_W.x() + sine * p_W.y(), -sine * p_W.x() + cosine * p_W.y()};
  }
};

/// Sine and cosine of an angle that changes little between calls. They are computed by power series from
/// those of a stored angle, exact to rounding; a large change stores the new angle.
/// Checked by tests/dynamics/bodies/body_equations_test.cpp
class NearbyRotation {
 public:
  FrameRotation at(double theta) {
    constexpr double kNearby = 0.03;  // rad: the truncation error of the series is below 1e-18
    const double turn = theta - kept_angle_, square = turn * turn;
    if (!(square < kNearby * kNearby)) return keep(theta);
    const double turn_sine =
        turn - turn * square * (1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0)));
    const double versine =
        square * (1.0 / 2.0 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square * (1.0 / 40320.0))));
    return {kept_.cosine - (versine * kept_.cosine + turn_sine * kept_.sine),
            kept_.sine + (turn_sine * kept_.cosine - versine * kept_.sine)};
  }

 private:
  FrameRotation keep(double theta);

  double kept_angle_ = 0.0;
  FrameRotation kept_;
};

/// S p: p turned by +90°.
inline Eigen::Vector2d turned(const Eigen::Vector2d& p) {
  return {-p.y(), p.x()};
}

/// First moment of mass of the deformed body about the frame's origin: S₀ + Pη, body axes [kg·m].
Eigen::Vector2d calc_first_moment(const Body& body, const Eigen::Ref<const Eigen::VectorXd>& eta);

}  // namespace sprung::dynamics
