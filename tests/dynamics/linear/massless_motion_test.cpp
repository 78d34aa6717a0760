// Bodies without mass: the motions that have none, and accelerations where all motions have some.
#include "dynamics/linear/massless_motion.h"

#include <cmath>
#include <memory>
#include <vector>

#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

constexpr double kGravity = 9.81, kLength = 0.7;

// A rod without mass, pinned to the ground at its upper end; welded or pinned to a point mass at its lower
// end.
Model make_rod_pendulum(bool is_welded) {
  Model model;
  model.gravity = {0.0, -kGravity};
  const int rod = test::add_body(model, dynamics::make_rigid_body("rod", 0.0, 0.0)),
            weight = test::add_body(model, dynamics::make_rigid_body("weight", 3.0, 0.0));
  test::add_pin(model, "pin", test::add_marker(model, dynamics::kGround, {0.0, 0.0}),
                test::add_marker(model, rod, {0.0, 0.5 * kLength}));
  const int end = test::add_marker(model, rod, {0.0, -0.5 * kLength}),
            center = test::add_marker(model, weight, {0.0, 0.0});
  if (is_welded) {
    model.joints.push_back(std::make_shared<dynamics::CoordinateJoint>(
        "weld", end, center, support::SourceLocation{"v.toml", 1, 1}, dynamics::make_fixed_joint(0.0)));
  } else {
    test::add_pin(model, "hook", end, center);
  }
  dynamics::number_model(model);
  return model;
}

VectorXd at_angle(double angle) {
  VectorXd q(6);
  q << 0.5 * kLength * std::sin(angle), -0.5 * kLength * std::cos(angle), angle, kLength * std::sin(angle),
      -kLength * std::cos(angle), angle;
  return q;
}

}  // namespace

TEST_CASE("A point mass on a rod without mass is the mathematical pendulum", "[analysis]") {
  const Model model = make_rod_pendulum(true);
  const VectorXd q = at_angle(0.8);
  CHECK_FALSE(dynamics::find_massless_motion(model, q));
  dynamics::PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  const int independent = equations.partition().independent.front();
  // Given by the angle's rate ω: θ̈ = −g/L sin θ, tension m (g cos θ + L ω²).
  const double omega = 2.0;
  VectorXd v(6);
  v << 0.5 * kLength * omega * std::cos(0.8), 0.5 * kLength * omega * std::sin(0.8), omega,
      kLength * omega * std::cos(0.8), kLength * omega * std::sin(0.8), omega;
  const std::vector<double> q_i{q[independent]}, v_i{v[independent]};
  REQUIRE(equations.update_motion(0.0, q_i, v_i) == dynamics::PartitionedEquations::Outcome::kGood);
  REQUIRE(equations.update_accelerations({}) == dynamics::PartitionedEquations::Outcome::kGood);
  CHECK(equations.v_dot()[2] == Approx(-kGravity / kLength * std::sin(0.8)).epsilon(1e-12));
  CHECK(equations.v_dot()[5] == Approx(-kGravity / kLength * std::sin(0.8)).epsilon(1e-12));
  const double tension = 3.0 * (kGravity * std::cos(0.8) + kLength * omega * omega);
  CHECK(equations.multipliers().head<2>().norm() == Approx(tension).epsilon(1e-12));
  const Eigen::MatrixXd mass = equations.calc_reduced_mass(equations.calc_directions());
  CHECK(mass(0, 0) > 0.0);
}

TEST_CASE("A freedom without mass is found by its body and coordinate", "[analysis]") {
  const Model model = make_rod_pendulum(false);
  const auto found = dynamics::find_massless_motion(model, at_angle(0.8));
  REQUIRE(found);
  CHECK(model.coordinate_name(*found) == "weight.angle");  // a point mass that nothing keeps from spinning
  Model free;
  test::add_body(free, dynamics::make_rigid_body("block", 2.0, 1.0));
  test::add_body(free, dynamics::make_rigid_body("ghost", 0.0, 1.0));
  dynamics::number_model(free);
  const auto ghost = dynamics::find_massless_motion(free, VectorXd::Zero(6));
  REQUIRE(ghost);
  CHECK(free.coordinate_name(*ghost).starts_with("ghost."));
}
