#include "dynamics/linear/equilibrium.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/linear/cantilevers.h"
#include "tests/dynamics/small_models.h"
#include "tests/tools/support/error_message.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;
using dynamics::Model;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

// A block on two upright springs from the ground, 0.8 m apart, and guided by nothing.
Model make_block_on_springs(double damping) {
  Model model;
  model.gravity = {0.0, -9.81};
  const int block = test::add_body(model, dynamics::make_rigid_body("block", 20.0, 1.5));
  for (const double x : {-0.4, 0.4}) {
    test::add_spring(model, x < 0.0 ? "left" : "right", test::add_marker(model, dynamics::kGround, {x, 0.0}),
                     test::add_marker(model, block, {x, 0.0}), 1.0, 4000.0, damping);
  }
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("From any start a pendulum's equilibrium is below its pivot", "[analysis]") {
  const Model model = test::make_pendulum(3.0, 0.6, 1.0, 9.81);
  for (const double angle : {0.0, 1.2, -2.5}) {
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, test::place_pendulum(0.6, angle));
    const double turned = std::remainder(rest.q[2] + 0.5 * pi, 2.0 * pi);
    CHECK(std::abs(turned) < 1e-10);
    CHECK(rest.stable);
    CHECK(rest.neutral.empty());
    CHECK(rest.last_step <= 1e-12);
  }
}

TEST_CASE("A block on springs sinks by its weight over their stiffness", "[analysis]") {
  const Model model = make_block_on_springs(0.0);
  VectorXd start(3);
  start << 0.0, 1.0, 0.0;
  const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, start);
  CHECK(rest.q[1] == Approx(1.0 - 20.0 * 9.81 / 8000.0).epsilon(1e-12));
  CHECK(rest.q[0] == Approx(0.0).margin(1e-12));
  CHECK(rest.q[2] == Approx(0.0).margin(1e-12));
  // On compressed springs it is unstable sideways: stiffness −F/length
  CHECK_FALSE(rest.stable);
  CHECK_THROWS_WITH(dynamics::calc_vehicle_modes(model, rest), Contains("unstable"));
}

TEST_CASE("The deflection of a beam under its own weight is that of beam theory", "[analysis]") {
  // Tip of a cantilever under its weight: q L⁴/(8 EI) [Gere & Goodno 2009, table H-1]; its first mode alone
  // gives 2 · 0.782992/1.875104⁴ of q L⁴/EI, a little more [Blevins 1979, table 8-1].
  const double EI = 2e4, length = 2.0, weight = 12.0;  // N·m², m, N/m
  std::vector<double> x;
  for (int i = 0; i <= 8; ++i) x.push_back(0.125 * length * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, 1e9, EI, weight / 9.81), 24);
  for (const int num_modes : {1, 24}) {
    Model model;
    model.gravity = {0.0, -9.81};
    std::vector<int> modes;
    for (int k = 1; k <= num_modes; ++k) modes.push_back(k);
    const int body = test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, modes));
    const int origin = test::add_marker(model, body, {0.0, 0.0}),
              side = test::add_marker(model, body, {0.0, 1.0});
    test::add_pin(model, "wall", origin, test::add_marker(model, dynamics::kGround, {0.0, 0.0}));
    // A rigid bar to the ground keeps the frame from turning.
    const int bar = test::add_body(model, dynamics::make_rigid_body("bar", 1e-3, 1e-3));
    test::add_pin(model, "bar_frame", test::add_marker(model, bar, {0.0, 0.0}), side);
    test::add_pin(model, "bar_wall", test::add_marker(model, bar, {-1.0, 0.0}),
                  test::add_marker(model, dynamics::kGround, {-1.0, 1.0}));
    const int tip = test::add_node_marker(model, body, beam.superelement, 8);
    dynamics::number_model(model);
    VectorXd start = VectorXd::Zero(model.num_coordinates);
    start[model.bodies[1].first_coordinate + 1] = 1.0;
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, start);
    dynamics::SystemTerms terms(model);
    terms.update_positions(0.0, rest.q);
    const double deflection = -terms.markers()[static_cast<std::size_t>(tip)].r.y();
    const double share = num_modes == 1 ? 2.0 * 0.782992 / std::pow(1.875104, 4) : 0.125;
    INFO(num_modes << " modes");
    CHECK(deflection == Approx(share * weight * std::pow(length, 4) / EI).epsilon(1e-5));
  }
}

namespace {

// A steel beam of 1 m with its frame at the root, fixed to the ground at one node and pushed across at
// another.
Model make_pushed_beam(int num_modes, int fixed, int pushed, double force, double EI = 2.1e4) {
  std::vector<double> x;
  for (int i = 0; i <= 8; ++i) x.push_back(0.125 * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, 2.1e8, EI, 7.85), num_modes);
  std::vector<int> modes;
  for (int k = 1; k <= num_modes; ++k) modes.push_back(k);
  Model model;
  const int body = test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, modes));
  const int held = test::add_node_marker(model, body, beam.superelement, fixed),
            tip = test::add_node_marker(model, body, beam.superelement, pushed);
  const int ground = test::add_marker(model, dynamics::kGround, {x[static_cast<std::size_t>(fixed)], 0.0});
  model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
      "clamp", ground, held, support::SourceLocation{}, dynamics::make_fixed_joint(0.0)));
  test::cantilevers::push(model, tip, dynamics::TimeFunction(force));
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("A beam held at the far end of its frame finds its equilibrium to rounding", "[analysis]") {
  // Modes of a cantilever from its root, fixed at the tip: three of the stiff ones follow from the others.
  for (const int num_modes : {8, 16, 22, 24}) {
    const Model model = make_pushed_beam(num_modes, 8, 0, -100.0);
    const dynamics::Equilibrium rest =
        dynamics::find_equilibrium(model, VectorXd::Zero(model.num_coordinates));
    INFO(num_modes << " modes, last step " << rest.last_step << ", rounding " << rest.rounding_step);
    CHECK(rest.last_step <= std::max(dynamics::Equilibrium::kTolerance, rest.rounding_step));
    CHECK(rest.last_step < 1e-7);
    // F L³/(3EI), with all modes; large for small rotations, so to a part in a thousand
    if (num_modes == 24) CHECK(rest.q[1] == Approx(-100.0 / (3.0 * 2.1e4)).epsilon(1e-3));
  }
}

TEST_CASE(
    "A slender beam held far from its frame finds its equilibrium where it bends by hundredths of its length",
    "[analysis]") {
  // The frame turns with the bending of the end where it is, and each step along the bending stretches the
  // beam, which is 3 million times stiffer that way. Deflection F L³/(3EI) = 2 % of the length; the error of
  // small rotations is of the order of its square.
  for (const int num_modes : {16, 24}) {
    const double EI = 60.0, force = -0.02 * 3.0 * EI;
    const Model model = make_pushed_beam(num_modes, 8, 0, force, EI);
    const dynamics::Equilibrium rest =
        dynamics::find_equilibrium(model, VectorXd::Zero(model.num_coordinates));
    INFO(num_modes << " modes, " << rest.iterations << " iterations");
    CHECK(rest.iterations < 40);
    if (num_modes == 24) CHECK(rest.q[1] == Approx(-0.02).epsilon(2e-3));
  }
}

TEST_CASE("A linear structure finds its equilibrium under loads of any size", "[analysis]") {
  for (const double force : {-1e2, -1e6, -1e9}) {
    const Model model = make_pushed_beam(24, 0, 8, force);
    const dynamics::Equilibrium rest =
        dynamics::find_equilibrium(model, VectorXd::Zero(model.num_coordinates));
    dynamics::SystemTerms terms(model);
    terms.update_positions(0.0, rest.q);
    INFO(force << " N");
    CHECK(terms.markers()[1].r.y() == Approx(force / (3.0 * 2.1e4)).epsilon(1e-7));
  }
}

TEST_CASE("A body that nothing holds has no equilibrium, and is named", "[analysis]") {
  Model model;
  model.gravity = {0.0, -9.81};
  test::add_body(model, dynamics::make_rigid_body("stone", 2.0, 0.3));
  test::add_marker(model, 0, {0.5, 0.0});
  dynamics::number_model(model);
  const std::string message =
      error_message<support::NumericalError>([&] { dynamics::find_equilibrium(model, VectorXd::Zero(3)); });
  CHECK_THAT(message, Contains("no static equilibrium"));
  CHECK_THAT(message, Contains("what keeps moving: all bodies along y"));

  // If another body is held, the free one is named by its coordinate.
  Model both = test::make_pendulum(3.0, 0.6, 1.0, 9.81);
  test::add_body(both, dynamics::make_rigid_body("stone", 2.0, 0.3));
  dynamics::number_model(both);
  VectorXd q(6);
  q << test::place_pendulum(0.6, -0.5 * pi), 5.0, 5.0, 0.2;
  const std::string named =
      error_message<support::NumericalError>([&] { dynamics::find_equilibrium(both, q); });
  CHECK_THAT(named, Contains("what keeps moving: stone.y"));
}

// A bar on a hinge falls from the upright position however near to it it starts: at 1e-8 rad the potential
// energy decreases by less than its rounding.
TEST_CASE("An unstable equilibrium is left from beside it", "[analysis]") {
  Model model;
  model.gravity = {0.0, -9.81};
  const int bar = test::add_body(model, dynamics::make_rigid_body("bar", 1.0, 0.1));
  test::add_pin(model, "hinge", test::add_marker(model, dynamics::kGround, {0.0, 0.0}),
                test::add_marker(model, bar, {-1.0, 0.0}));
  dynamics::number_model(model);
  for (const double away : {1e-3, 1e-6, 2.7e-8, 3e-9, -2.7e-8}) {
    const double angle = 0.5 * std::numbers::pi - away;
    VectorXd q(3);
    q << std::cos(angle), std::sin(angle), angle;
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, q);
    CHECK(rest.stable);
    CHECK(rest.q[1] == Approx(-1.0).epsilon(1e-10));
  }
}

TEST_CASE("Neutral directions are found, named and held where they start", "[analysis]") {
  SECTION("a free body without gravity: three") {
    Model model;
    test::add_body(model, dynamics::make_rigid_body("stone", 2.0, 0.3));
    test::add_marker(model, 0, {0.5, 0.0});
    dynamics::number_model(model);
    VectorXd q(3);
    q << 1.0, 2.0, 0.5;
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, q);
    CHECK(rest.neutral.size() == 3);
    CHECK((rest.q - q).norm() < 1e-12);
  }
  SECTION("a wheel on the road: it may roll on, and turn about its centre") {
    const dynamics::FlatRoad road;
    Model model;
    model.gravity = {0.0, -9.81};
    const int wheel = test::add_body(model, dynamics::make_rigid_body("wheel", 50.0, 2.0));
    model.forces.push_back(std::make_unique<dynamics::PointContactTyre>(
        "tyre",
        dynamics::PointContactTyre::Parameters{
            .marker = test::add_marker(model, wheel, {0.0, 0.0}),
            .radius = 0.4,
            .spring = dynamics::PiecewisePolynomial(std::vector<double>{0.0, 1e5})},
        dynamics::PlacedRoad{&road, 1.0, 0.0}));
    dynamics::number_model(model);
    VectorXd q(3);
    q << 7.0, 0.6, 0.3;  // 0.2 m above the ground
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(model, q);
    CHECK(rest.q[0] == 7.0);
    CHECK(rest.q[1] == Approx(0.4 - 50.0 * 9.81 / 1e5).epsilon(1e-10));
    CHECK(rest.q[2] == 0.3);
    REQUIRE(rest.neutral.size() == 2);
    const bool x_first = rest.neutral[0].description == "all bodies along x";
    CHECK(rest.neutral[x_first ? 0 : 1].description == "all bodies along x");
    CHECK(rest.neutral[x_first ? 1 : 0].description == "wheel.angle");
  }
}
