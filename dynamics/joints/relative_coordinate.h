#pragma once

#include <Eigen/Core>
#include <string_view>

#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

/// A scalar that describes the position or angle of marker b relative to marker a. Joints hold such
/// coordinates, and prescribed motion drives them (joints, eqs. 3, 5).
/// Checked by tests/dynamics/joints/relative_coordinate_test.cpp
class RelativeCoordinate {
 public:
  enum class Kind {
    kX,         ///< x_b − x_a, world axes [m]
    kY,         ///< y_b − y_a, world axes [m]
    kAngle,     ///< angle_b − angle_a [rad]
    kAlong,     ///< (r_b − r_a) · axis, the axis turning with a [m]
    kDistance,  ///< |r_b − r_a| [m]; has no derivative where both points coincide
  };
  /// @param axis  for kAlong: its direction in the axes of a's body, not zero
  explicit RelativeCoordinate(Kind kind, const Eigen::Vector2d& axis = Eigen::Vector2d::UnitX())
      : kind_(kind), axis_(axis.normalized()) {}

  Kind kind() const { return kind_; }
  /// The axis of kAlong, a unit vector in the axes of a's body.
  const Eigen::Vector2d& axis() const { return axis_; }
  bool is_angle() const { return kind_ == Kind::kAngle; }

  double value(const MarkerState& a, const MarkerState& b) const;
  double rate(const MarkerState& a, const MarkerState& b) const;

  /// ∂c/∂(δx, δy, δangle) of a and of b.
  struct Gradient {
    Eigen::RowVector3d a, b;
  };
  Gradient gradient(const MarkerState& a, const MarkerState& b) const;
  /// Whether the gradient is the same at all positions, as for x, y and angle.
  bool has_constant_gradient() const {
    return kind_ == Kind::kX || kind_ == Kind::kY || kind_ == Kind::kAngle;
  }
  /// c̈ without the accelerations of the markers: Ġ_a (v_a, ω_a) + Ġ_b (v_b, ω_b).
  double drift(const MarkerState& a, const MarkerState& b) const;

 private:
  Eigen::Vector2d world_axis(const MarkerState& a) const;
  Kind kind_;
  Eigen::Vector2d axis_;  // unit, axes of a's body
};

/// The name that a results file uses: "along".
std::string_view coordinate_kind_name(RelativeCoordinate::Kind kind);

}  // namespace sprung::dynamics
