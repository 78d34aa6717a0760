#pragma once

#include "dynamics/joints/joint.h"

namespace sprung::dynamics {

/// Two markers that coincide, free to rotate: r_a − r_b = 0, two constraints in world axes (joints, eq. 1).
/// Checked by tests/dynamics/joints/revolute_joint_test.cpp
class RevoluteJoint final : public Joint {
 public:
  using Joint::Joint;
  std::string_view kind() const override { return "revolute"; }
  ElementDescription describe() const override {
    return {.points = {"a", "b"}, .parameters = {}, .drawing = Drawing::kPin};
  }
  std::optional<RelativeCoordinate> coordinate() const override {
    return RelativeCoordinate(RelativeCoordinate::Kind::kAngle);
  }
  bool carries_torque() const override { return false; }
  bool carries_torque_at_b() const override { return false; }
  int num_constraints() const override { return 2; }
  std::string_view constraint_name(int k) const override { return k == 0 ? "x" : "y"; }
  bool is_angle(int /*k*/) const override { return false; }
  void calc_residual(const MarkerState& a, const MarkerState& b, double time,
                     JointVector& phi) const override;
  void calc_jacobian(const MarkerState& a, const MarkerState& b, JointJacobian& Ga,
                     JointJacobian& Gb) const override;
  bool has_constant_jacobian() const override { return true; }
  void calc_drift(const MarkerState& a, const MarkerState& b, double time, JointVector& drift) const override;
};

}  // namespace sprung::dynamics
