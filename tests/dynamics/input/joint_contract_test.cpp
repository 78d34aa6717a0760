// What the solver takes for granted of every joint, for those of the examples in dynamics/models/README.md,
// which hold every kind, and for motions of a point.
#include <Eigen/Core>

#include "dynamics/input/make_model.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/input/reference.h"
#include "tests/dynamics/marker_motion.h"
#include "tests/dynamics/random_numbers.h"
#include "tools/support/toml/toml.h"

using namespace sprung;

namespace {

using dynamics::Joint;
using dynamics::JointJacobian;
using dynamics::JointVector;
using test::MarkerMotion;

constexpr double kTime = 0.7;  // at which functions of time vary [s]
constexpr double kZero = 1e-9;

const std::string kMotionsOfPoint = R"(
[[motions]]
name = "along"
point = "rider.origin"
coordinate = "x"
function = { harmonic = { mean = 0.0, amplitude = 0.2, frequency = 1.5, phase = 0.0 } }

[[motions]]
name = "up"
point = "rider.origin"
coordinate = "y"
function = { polynomial = [0.0, 0.5, 0.1] }
)";

// A joint between two markers that move near where they are drawn.
struct MovingJoint {
  const Joint& joint;
  MarkerMotion a, b;

  JointVector residual(double t) const {
    JointVector phi;
    joint.calc_residual(a.at(t), b.at(t), kTime + t, phi);
    return phi;
  }
  JointVector time_rate() const {
    JointVector phi_t;
    joint.calc_time_rate(a.at(0.0), b.at(0.0), kTime, phi_t);
    return phi_t;
  }
  JointVector drift() const {
    JointVector drift;
    joint.calc_drift(a.at(0.0), b.at(0.0), kTime, drift);
    return drift;
  }
  struct Jacobians {
    JointJacobian a, b;
  };
  Jacobians jacobians(double t) const {
    Jacobians G;
    joint.calc_jacobian(a.at(t), b.at(t), G.a, G.b);
    return G;
  }
};

struct Joints {
  dynamics::FlatRoad road;
  dynamics::Vehicle vehicle;
  dynamics::Model model;
  std::vector<MovingJoint> moving;

  Joints() {
    test::write_history();
    const auto file =
        support::TomlDocument::parse(test::read_reference().vehicle + kMotionsOfPoint, "vehicle");
    vehicle = dynamics::read_vehicle(file, test::superelement_folder());
    model = dynamics::make_model(vehicle, {}, {.road = &road});
    dynamics::SystemTerms terms(model);
    terms.update_positions(0.0, dynamics::make_start_positions(model, vehicle));
    test::RandomNumbers random(4);
    const auto move = [&](int marker) {
      const dynamics::MarkerState& drawn = terms.markers()[static_cast<std::size_t>(marker)];
      return MarkerMotion{.r = drawn.r + random.vector(2, 0.05),
                          .v = random.vector(2, 1.0),
                          .a = random.vector(2, 1.0),
                          .angle = drawn.angle + random.size_up_to(0.5),
                          .omega = random.size_up_to(1.0),
                          .alpha = random.size_up_to(1.0)};
    };
    for (const auto& joint : model.joints)
      moving.push_back({*joint, move(joint->marker_a), move(joint->marker_b)});
  }
};

}  // namespace

TEST_CASE("The derivatives of every joint are those of its residual") {
  const Joints joints;
  for (const MovingJoint& one : joints.moving) {
    CAPTURE(one.joint.name, one.joint.kind());
    REQUIRE(one.residual(0.0).size() == one.joint.num_constraints());
    const auto residual = [&](double t) { return one.residual(t); };
    const auto G = one.jacobians(0.0);
    const JointVector rate = G.a * one.a.velocity() + G.b * one.b.velocity() + one.time_rate();
    CHECK((rate - test::calc_rate(residual)).norm() < 1e-6);
    const JointVector second = G.a * one.a.acceleration() + G.b * one.b.acceleration() + one.drift();
    CHECK((second - test::calc_second_rate(residual)).norm() < 1e-5);
  }
}

TEST_CASE("Every joint says what its Jacobian and its constraints depend on") {
  const Joints joints;
  for (const MovingJoint& one : joints.moving) {
    CAPTURE(one.joint.name, one.joint.kind());
    const auto G = one.jacobians(0.0), later = one.jacobians(0.5);
    const double change = (later.a - G.a).norm() + (later.b - G.b).norm();
    CHECK(one.joint.has_constant_jacobian() == (change < kZero));
    CHECK(one.joint.time_functions().empty() == one.time_rate().isZero(0.0));
    for (int k = 0; k < one.joint.num_constraints(); ++k) {
      CAPTURE(k);
      CHECK(one.joint.is_angle(k) == (G.b.row(k).head<2>().norm() < kZero));
      CHECK_FALSE(one.joint.constraint_name(k).empty());
    }
  }
}

TEST_CASE("Every joint says at which of its points its reaction contains a torque") {
  const Joints joints;
  for (const MovingJoint& one : joints.moving) {
    CAPTURE(one.joint.name, one.joint.kind());
    const auto G = one.jacobians(0.0);
    CHECK(one.joint.carries_torque() == (G.a.col(2).norm() > kZero));
    CHECK(one.joint.carries_torque_at_b() == (G.b.col(2).norm() > kZero));
  }
}

TEST_CASE("The coordinate of a joint that motion may drive is that of its results") {
  const Joints joints;
  for (std::size_t j = 0; j < joints.vehicle.joints.size(); ++j) {
    const MovingJoint& one = joints.moving[j];
    CAPTURE(one.joint.name, one.joint.kind());
    const std::optional<dynamics::RelativeCoordinate>& drivable = joints.vehicle.joints[j].drivable;
    if (!drivable) continue;
    REQUIRE(one.joint.coordinate());
    const dynamics::MarkerState a = one.a.at(0.0), b = one.b.at(0.0);
    CHECK(one.joint.coordinate()->value(a, b) == drivable->value(a, b));
  }
}
