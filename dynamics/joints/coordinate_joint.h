#pragma once

#include <optional>
#include <vector>

#include "dynamics/functions/time_function.h"
#include "dynamics/joints/joint.h"

namespace sprung::dynamics {

/// Keeps up to three relative coordinates of two markers at values that may be functions of time:
/// φ_k = c_k(a, b) − f_k(t): joints that hold relative coordinates, and all prescribed motion (joints,
/// eqs. 3–6).
/// Checked by tests/dynamics/joints/coordinate_joint_test.cpp
class CoordinateJoint final : public Joint {
 public:
  struct Held {
    RelativeCoordinate coordinate;
    TimeFunction value;
    std::string_view name;  ///< for messages: "across the axis"
  };
  struct Parts {
    std::string_view kind;
    std::vector<Held> held;  ///< 1 to 3
    /// The coordinate that results show: free, driven, or the length of a distance joint; none if nothing is
    /// free.
    std::optional<RelativeCoordinate> coordinate;
    std::vector<Parameter> parameters = {};  ///< for results files
    Drawing drawing = Drawing::kPin;
    bool is_motion = false;  ///< prescribed motion: the first held coordinate is driven
  };
  /// @throws std::invalid_argument for no held coordinate, or more than three
  CoordinateJoint(std::string joint_name, int marker_of_a, int marker_of_b, support::SourceLocation where,
                  Parts parts);

  std::string_view kind() const override { return parts_.kind; }
  ElementDescription describe() const override {
    return {.points = {"a", "b"}, .parameters = parts_.parameters, .drawing = parts_.drawing};
  }
  bool is_motion() const override { return parts_.is_motion; }
  std::optional<RelativeCoordinate> coordinate() const override { return parts_.coordinate; }

  bool carries_torque() const override;
  bool carries_torque_at_b() const override;
  int num_constraints() const override { return static_cast<int>(parts_.held.size()); }
  std::string_view constraint_name(int k) const override { return held(k).name; }
  bool is_angle(int k) const override { return held(k).coordinate.is_angle(); }

  void calc_residual(const MarkerState& a, const MarkerState& b, double time,
                     JointVector& phi) const override;
  void calc_jacobian(const MarkerState& a, const MarkerState& b, JointJacobian& Ga,
                     JointJacobian& Gb) const override;
  bool has_constant_jacobian() const override;
  void calc_time_rate(const MarkerState& a, const MarkerState& b, double time,
                      JointVector& phi_t) const override;
  void calc_drift(const MarkerState& a, const MarkerState& b, double time, JointVector& drift) const override;

  std::vector<const TimeFunction*> time_functions() const override;
  double calc_longest_step(double time, double length_scale) const override;

 private:
  const Held& held(int k) const { return parts_.held[static_cast<std::size_t>(k)]; }
  Parts parts_;
};

/// Marker b slides along an axis that is fixed to a, at a constant angle to a: two constraints.
/// @param axis   in the axes of a's body, not zero
/// @param angle  of b relative to a [rad]
CoordinateJoint::Parts make_translational_joint(const Eigen::Vector2d& axis, double angle);
/// Marker b coincides with a at a constant angle to it: three constraints.
/// @param angle  of b relative to a [rad]
CoordinateJoint::Parts make_fixed_joint(double angle);
/// A massless link, free to rotate at both ends, between a and b: one constraint.
/// @param length  > 0 at all times [m]
CoordinateJoint::Parts make_distance_joint(const TimeFunction& length);
/// A pin, marker b, slides along a line through a that turns with a, free to rotate: one constraint.
/// @param axis  in the axes of a's body, not zero
CoordinateJoint::Parts make_pin_in_slot_joint(const Eigen::Vector2d& axis);
/// Prescribed motion: a coordinate follows a function of time, one constraint.
/// @param value  continuously differentiable [m, rad]
CoordinateJoint::Parts make_motion(const RelativeCoordinate& coordinate, const TimeFunction& value);

}  // namespace sprung::dynamics
