#include "dynamics/joints/revolute_joint.h"

#include <Eigen/Core>

#include "tests/catch.h"

using namespace sprung;
using dynamics::JointJacobian;
using dynamics::JointVector;
using dynamics::MarkerState;
using Eigen::Vector2d;

namespace {

MarkerState marker(const Vector2d& r, const Vector2d& v, double omega) {
  MarkerState state;
  state.r = r;
  state.v = v;
  state.omega = omega;
  return state;
}

}  // namespace

TEST_CASE("A revolute joint holds two points together and lets them turn", "[joints]") {
  const dynamics::RevoluteJoint joint("hinge", 3, 5, {"vehicle.toml", 7, 2});
  CHECK(joint.marker_a == 3);
  CHECK(joint.marker_b == 5);
  CHECK(joint.location.line == 7);
  REQUIRE(joint.num_constraints() == 2);
  CHECK(joint.constraint_name(0) == "x");
  CHECK(joint.constraint_name(1) == "y");

  const MarkerState a = marker({1.0, 2.0}, {0.3, -0.4}, 5.0), b = marker({0.7, 2.5}, {-1.1, 0.6}, -2.0);
  JointVector phi;
  joint.calc_residual(a, b, 0.0, phi);
  CHECK((phi - Vector2d(0.3, -0.5)).norm() < 1e-15);

  // φ̇ = Ga (v_a, ω_a) + Gb (v_b, ω_b) is the points' relative velocity, for any angular velocities.
  JointJacobian Ga, Gb;
  joint.calc_jacobian(a, b, Ga, Gb);
  REQUIRE(Ga.rows() == 2);
  REQUIRE(Gb.rows() == 2);
  const Vector2d rate =
      Ga * Eigen::Vector3d(a.v.x(), a.v.y(), a.omega) + Gb * Eigen::Vector3d(b.v.x(), b.v.y(), b.omega);
  CHECK((rate - (a.v - b.v)).norm() < 1e-15);

  JointVector rate_by_time, drift;
  joint.calc_time_rate(a, b, 1.0, rate_by_time);
  joint.calc_drift(a, b, 1.0, drift);
  REQUIRE(rate_by_time.size() == 2);
  REQUIRE(drift.size() == 2);
  CHECK(rate_by_time.isZero(0.0));
  CHECK(drift.isZero(0.0));
}
