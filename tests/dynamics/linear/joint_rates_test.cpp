#include "dynamics/linear/joint_rates.h"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"
#include "tests/tools/support/error_message.h"

using namespace sprung;
using dynamics::JointRate;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

JointRate at_line(int joint, double rate, int line) {
  return {.joint = joint, .rate = rate, .location = {.path = "run.toml", .line = line, .column = 9}};
}

// A crank of 0.5 m, a rod of 1.2 m and a piston on a line through the crank's axle, at 0.7 rad.
struct SliderCrank {
  Model model;
  VectorXd q;

  SliderCrank() {
    const int crank = test::add_body(model, dynamics::make_rigid_body("crank", 1.0, 0.1)),
              rod = test::add_body(model, dynamics::make_rigid_body("rod", 2.0, 0.3)),
              piston = test::add_body(model, dynamics::make_rigid_body("piston", 3.0, 0.2));
    const int axle = test::add_marker(model, dynamics::kGround, {0.0, 0.0});
    test::add_pin(model, "axle", axle, test::add_marker(model, crank, {-0.25, 0.0}));
    test::add_pin(model, "pin", test::add_marker(model, crank, {0.25, 0.0}),
                  test::add_marker(model, rod, {-0.6, 0.0}));
    test::add_pin(model, "gudgeon", test::add_marker(model, rod, {0.6, 0.0}),
                  test::add_marker(model, piston, {0.0, 0.0}));
    model.joints.push_back(std::make_shared<dynamics::CoordinateJoint>(
        "rail", axle, test::add_marker(model, piston, {0.0, 0.0}), support::SourceLocation{"v.toml", 9, 1},
        dynamics::make_translational_joint({1.0, 0.0}, 0.0)));
    dynamics::number_model(model);
    q.setZero(9);
    q << 0.2, 0.2, 0.7, 0.9, 0.2, -0.3, 1.5, 0.0, 0.0;
    dynamics::assemble_positions(model, q);
  }
};

}  // namespace

TEST_CASE("A crank's rate moves the whole mechanism as its geometry requires", "[analysis]") {
  SliderCrank s;
  VectorXd v = VectorXd::Zero(9);
  dynamics::impose_joint_rates(s.model, s.q, std::vector{at_line(0, 3.0, 5)}, v);
  // Piston at x = r cos α + √(l² − r² sin² α) with the crank's angle α.
  const double alpha = s.q[2], r = 0.5, l = 1.2;
  const double rod = std::sqrt(l * l - std::pow(r * std::sin(alpha), 2));
  const double by_angle = -r * std::sin(alpha) - r * r * std::sin(alpha) * std::cos(alpha) / rod;
  CHECK(v[2] == Approx(3.0).epsilon(1e-13));
  CHECK(v[6] == Approx(3.0 * by_angle).epsilon(1e-12));
  CHECK(v[5] == Approx(-3.0 * r * std::cos(alpha) / rod).epsilon(1e-12));
  // The other way round: the piston's rate drives the crank. Rates that agree need not be left out.
  VectorXd back = VectorXd::Zero(9);
  dynamics::impose_joint_rates(s.model, s.q, std::vector{at_line(3, v[6], 5), at_line(0, 3.0, 6)}, back);
  CHECK((back - v).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("A rate that contradicts the joints or another rate is refused at its place", "[analysis]") {
  SliderCrank s;
  VectorXd v = VectorXd::Zero(9);
  const std::string message = error_message<support::InputError>([&] {
    dynamics::impose_joint_rates(s.model, s.q, std::vector{at_line(0, 0.0, 5), at_line(3, 1.0, 6)}, v);
  });
  CHECK(
      message ==
      "run.toml:6:9: error: 'joint_rates.rail' must be 0 m/s, as the joints, prescribed motion and the rates "
      "before it require, got 1");
}

TEST_CASE("The other motions of an open chain change by an impulse between the joint's bodies",
          "[analysis]") {
  // Two free discs pinned at their rims, at rest: the torque of the joint turns them against each other and
  // leaves momentum and angular momentum as they were.
  Model model;
  for (const char* name : {"one", "two"}) test::add_body(model, dynamics::make_rigid_body(name, 2.0, 0.5));
  test::add_pin(model, "rim", test::add_marker(model, 0, {0.4, 0.0}),
                test::add_marker(model, 1, {-0.4, 0.0}));
  dynamics::number_model(model);
  VectorXd q(6), v = VectorXd::Zero(6);
  q << 0.0, 0.0, 0.0, 0.8, 0.0, 0.0;
  dynamics::impose_joint_rates(model, q, std::vector{at_line(0, 2.0, 5)}, v);
  CHECK(v[5] - v[2] == Approx(2.0).epsilon(1e-13));
  CHECK(v[2] == Approx(-1.0).epsilon(1e-13));  // equal discs share the rate
  CHECK(std::abs(v[0] + v[3]) + std::abs(v[1] + v[4]) < 1e-13);
}

TEST_CASE("A flexible body that is turned by its joint does not vibrate", "[analysis]") {
  const test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("beam", {0.0, 0.25, 0.5, 0.75, 1.0}, 8e6, 300.0, 6.0), 6);
  Model model;
  test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, {1, 2, 3, 4, 5, 6}));
  test::add_pin(model, "hinge", test::add_marker(model, dynamics::kGround, {0.0, 0.0}),
                test::add_node_marker(model, 0, beam.superelement, 0));
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(9), v = VectorXd::Zero(9);
  dynamics::impose_joint_rates(model, q, std::vector{at_line(0, 2.0, 5)}, v);
  CHECK(v[2] == Approx(2.0).epsilon(1e-13));
  CHECK(v.tail(6).cwiseAbs().maxCoeff() == 0.0);
}
