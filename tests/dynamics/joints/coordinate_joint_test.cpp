#include "dynamics/joints/coordinate_joint.h"

#include <cmath>

#include "tests/catch.h"

using namespace sprung;
using dynamics::CoordinateJoint;
using dynamics::JointVector;
using dynamics::MarkerState;
using dynamics::RelativeCoordinate;
using dynamics::TimeFunction;
using Kind = RelativeCoordinate::Kind;

namespace {

CoordinateJoint make(CoordinateJoint::Parts parts) {
  return CoordinateJoint("joint", 1, 2, {"vehicle.toml", 3, 4}, std::move(parts));
}

JointVector residual(const CoordinateJoint& joint, const MarkerState& a, const MarkerState& b,
                     double time = 0.0) {
  JointVector phi;
  joint.calc_residual(a, b, time, phi);
  return phi;
}

// b where an axis (0.6, 0.8) of a, turned by 0.7, has it at this distance, and at this angle against a.
struct Pair {
  MarkerState a, b;
  Pair(double along, double across, double angle) {
    a.r = {0.4, -1.2};
    a.angle = 0.7;
    const dynamics::FrameRotation R = dynamics::FrameRotation::from_angle(0.7);
    b.r = a.r + along * (R * Eigen::Vector2d(0.6, 0.8)) + across * (R * Eigen::Vector2d(-0.8, 0.6));
    b.angle = a.angle + angle;
  }
};

constexpr double kRounding = 1e-14;

}  // namespace

TEST_CASE("Each kind of joint holds its constraints and leaves the rest free", "[joints]") {
  const CoordinateJoint translational = make(dynamics::make_translational_joint({3.0, 4.0}, 0.2));
  REQUIRE(translational.num_constraints() == 2);
  CHECK(residual(translational, Pair(5.0, 0.0, 0.2).a, Pair(5.0, 0.0, 0.2).b).norm() < kRounding);
  const JointVector off = residual(translational, Pair(5.0, 0.3, 0.5).a, Pair(5.0, 0.3, 0.5).b);
  CHECK(off[0] == Approx(0.3).epsilon(1e-13));
  CHECK(off[1] == Approx(0.3).epsilon(1e-13));
  CHECK(translational.constraint_unit(0) == "m");
  CHECK(translational.constraint_unit(1) == "rad");
  CHECK(translational.coordinate()->value(Pair(5.0, 0.0, 0.2).a, Pair(5.0, 0.0, 0.2).b) == Approx(5.0));

  const CoordinateJoint slot = make(dynamics::make_pin_in_slot_joint({0.6, 0.8}));
  REQUIRE(slot.num_constraints() == 1);
  CHECK(std::abs(residual(slot, Pair(-2.0, 0.0, 1.9).a, Pair(-2.0, 0.0, 1.9).b)[0]) < kRounding);
  CHECK(residual(slot, Pair(-2.0, -0.1, 1.9).a, Pair(-2.0, -0.1, 1.9).b)[0] == Approx(-0.1).epsilon(1e-13));

  const CoordinateJoint fixed = make(dynamics::make_fixed_joint(-0.4));
  REQUIRE(fixed.num_constraints() == 3);
  CHECK(residual(fixed, Pair(0.0, 0.0, -0.4).a, Pair(0.0, 0.0, -0.4).b).norm() < kRounding);
  CHECK(residual(fixed, Pair(0.5, 0.0, -0.4).a, Pair(0.5, 0.0, -0.4).b).norm() == Approx(0.5));
  CHECK_FALSE(fixed.coordinate());

  const CoordinateJoint distance = make(dynamics::make_distance_joint(TimeFunction(2.5)));
  REQUIRE(distance.num_constraints() == 1);
  CHECK(std::abs(residual(distance, Pair(1.5, 2.0, 9.0).a, Pair(1.5, 2.0, 9.0).b)[0]) < kRounding);
  CHECK(distance.time_functions().empty());
}

// The force of a slot acts at the pin, which is b, and turns a.
TEST_CASE("A joint tells which of its points bears a torque", "[joints]") {
  const CoordinateJoint slot = make(dynamics::make_pin_in_slot_joint({0.6, 0.8}));
  CHECK(slot.carries_torque());
  CHECK_FALSE(slot.carries_torque_at_b());
  const CoordinateJoint fixed = make(dynamics::make_fixed_joint(0.0));
  CHECK(fixed.carries_torque_at_b());
  const CoordinateJoint distance = make(dynamics::make_distance_joint(TimeFunction(2.5)));
  CHECK_FALSE(distance.carries_torque());
  CHECK_FALSE(distance.carries_torque_at_b());
}

TEST_CASE("Prescribed motion enters with its rate and acceleration", "[joints]") {
  const TimeFunction swing =
      TimeFunction::harmonic({.mean = 0.3, .amplitude = 0.2, .frequency_hz = 1.5, .phase = 0.4});
  const CoordinateJoint motion = make(dynamics::make_motion(RelativeCoordinate(Kind::kAngle), swing));
  CHECK(motion.is_motion());
  CHECK(motion.time_functions().size() == 1);
  const Pair pair(0.0, 0.0, 0.9);
  const double t = 0.37, omega = 2.0 * 3.14159265358979323846 * 1.5, phase = omega * t + 0.4;
  CHECK(residual(motion, pair.a, pair.b, t)[0] == Approx(0.9 - 0.3 - 0.2 * std::sin(phase)).epsilon(1e-13));
  JointVector rate, drift;
  motion.calc_time_rate(pair.a, pair.b, t, rate);
  motion.calc_drift(pair.a, pair.b, t, drift);
  CHECK(rate[0] == Approx(-0.2 * omega * std::cos(phase)).epsilon(1e-13));
  CHECK(drift[0] == Approx(0.2 * omega * omega * std::sin(phase)).epsilon(1e-13));
}

TEST_CASE("A step of the integrator moves prescribed motion by a part of the natural size", "[joints]") {
  const CoordinateJoint turning =
      make(dynamics::make_motion(RelativeCoordinate(Kind::kAngle), TimeFunction::polynomial({0.0, 10.0})));
  CHECK(turning.calc_longest_step(0.0, 3.0) == Approx(0.25 / 10.0));
  const CoordinateJoint sliding =
      make(dynamics::make_motion(RelativeCoordinate(Kind::kX), TimeFunction::polynomial({0.0, -4.0})));
  CHECK(sliding.calc_longest_step(0.0, 3.0) == Approx(0.25 * 3.0 / 4.0));
  CHECK(std::isinf(make(dynamics::make_fixed_joint(0.0)).calc_longest_step(0.0, 3.0)));
}

TEST_CASE("A joint of no coordinates, or of too many, is refused", "[joints]") {
  CHECK_THROWS_WITH(make({}), "CoordinateJoint: holds 1 to 3 coordinates, got 0");
}
