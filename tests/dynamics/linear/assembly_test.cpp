#include "dynamics/linear/assembly.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/chains.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"
#include "tests/tools/support/error_message.h"
#include "tools/support/errors/input_error.h"

using namespace sprung;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

// A crank, a coupler and a rocker between two posts 0.9 m apart: 0.4, 1.0, 0.8 m long.
Model make_four_bar(double coupler_length) {
  Model model;
  const double length[] = {0.4, coupler_length, 0.8};
  const char* names[] = {"crank", "coupler", "rocker"};
  for (int i = 0; i < 3; ++i) test::add_body(model, dynamics::make_rigid_body(names[i], 2.0, 0.3));
  const auto end = [&](int body, double side) {
    return test::add_marker(model, body, {0.5 * side * length[body], 0.0}, side < 0.0 ? "start" : "end");
  };
  test::add_pin(model, "crank_post", test::add_marker(model, dynamics::kGround, {0.0, 0.0}), end(0, -1.0));
  test::add_pin(model, "crank_pin", end(0, 1.0), end(1, -1.0));
  test::add_pin(model, "rocker_pin", end(1, 1.0), end(2, 1.0));
  test::add_pin(model, "rocker_post", test::add_marker(model, dynamics::kGround, {0.9, 0.0}), end(2, -1.0));
  dynamics::number_model(model);
  return model;
}

VectorXd rough_four_bar() {
  VectorXd q(9);
  q << 0.1, 0.2, 1.0, 0.6, 0.6, 0.4, 1.0, 0.4, 1.4;
  return q;
}

double largest_residual(const Model& model, const VectorXd& q) {
  dynamics::SystemTerms terms(model);
  terms.update_positions(0.0, q);
  VectorXd phi(model.num_constraints);
  terms.calc_residual(phi);
  return phi.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("A mechanism at rough positions is closed, and the report says how far it moved", "[analysis]") {
  const Model model = make_four_bar(1.0);
  VectorXd q = rough_four_bar();
  const VectorXd rough = q;
  REQUIRE(largest_residual(model, q) > 0.02);
  const dynamics::AssemblyReport report = dynamics::assemble_positions(model, q);
  CHECK(largest_residual(model, q) < 1e-12);
  CHECK(report.residual < 1e-12);
  CHECK(report.largest_movement > 0.01);
  CHECK(report.largest_movement < 0.5);
  CHECK_FALSE(report.moved_marker.empty());
  CHECK((q - rough).norm() > 0.0);
  // A second time there is nothing to do
  VectorXd again = q;
  CHECK(dynamics::assemble_positions(model, again).largest_movement == 0.0);
  CHECK(again == q);
}

TEST_CASE("A ring of 10,000 links that is drawn to a centimetre is closed", "[analysis]") {
  const test::Chain ring = test::make_closed_chain(10'000);
  test::RandomNumbers random(1);
  VectorXd q = ring.state.q + random.vector(ring.state.q.size(), 0.01);
  const dynamics::AssemblyReport report = dynamics::assemble_positions(ring.model, q);
  CHECK(largest_residual(ring.model, q) < 1e-11);  // the ring's diameter is 640 m, whose rounding is 1e-13
  CHECK(report.largest_movement < 0.1);
}

TEST_CASE("Assembly moves heavy bodies least", "[analysis]") {
  // Two points 1 cm apart, bodies of 1 and 99 kg that need not turn: the heavy one moves by a hundredth of
  // the gap.
  Model model;
  test::add_body(model, dynamics::make_rigid_body("light", 1.0, 1.0));
  test::add_body(model, dynamics::make_rigid_body("heavy", 99.0, 99.0));
  test::add_pin(model, "pin", test::add_marker(model, 0, {0.0, 0.0}), test::add_marker(model, 1, {0.0, 0.0}));
  test::add_marker(model, 0, {1.0, 0.0});
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(6);
  q[0] = 0.01;
  dynamics::assemble_positions(model, q);
  CHECK(q[0] == Approx(1e-4).epsilon(1e-6));
  CHECK(q[3] == Approx(1e-4).epsilon(1e-6));
}

TEST_CASE("Joints that cannot be closed are an input error at the joint that stays open", "[analysis]") {
  Model apart;
  test::add_body(apart, dynamics::make_rigid_body("bar", 1.0, 1.0));
  test::add_pin(apart, "left", test::add_marker(apart, 0, {-0.5, 0.0}),
                test::add_marker(apart, dynamics::kGround, {0.0, 0.0}));
  test::add_pin(apart, "right", test::add_marker(apart, 0, {0.5, 0.0}),
                test::add_marker(apart, dynamics::kGround, {1.3, 0.0}));
  dynamics::number_model(apart);
  VectorXd position(3);
  position << 0.6, 0.05, 0.1;
  const std::string message =
      error_message<support::InputError>([&] { dynamics::assemble_positions(apart, position); });
  CHECK_THAT(message, Contains("test.toml:1:1"));
  CHECK_THAT(message, Contains("the joints cannot be closed from the given positions"));
  CHECK_THAT(message, Contains("'left'") && Contains("'right'"));
  CHECK_THAT(message, Contains("0.15 m apart"));  // the bar of 1 m between posts 1.3 m apart, in their middle
}

TEST_CASE("Redundant joints are an input error that names them", "[analysis]") {
  // Two doors: the first on one hinge, the second on two.
  Model model;
  test::add_body(model, dynamics::make_rigid_body("sound", 1.0, 1.0));
  test::add_body(model, dynamics::make_rigid_body("door", 1.0, 1.0));
  const auto hinge = [&](int body, double x, const std::string& name) {
    test::add_pin(model, name, test::add_marker(model, body, {x, 0.0}),
                  test::add_marker(model, dynamics::kGround, {x, 0.0}));
  };
  hinge(0, 0.7, "only");
  hinge(1, 0.2, "upper");
  hinge(1, 1.1, "lower");
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(6);
  const std::string message =
      error_message<support::InputError>([&] { dynamics::assemble_positions(model, q); });
  CHECK_THAT(message,
             Contains("redundant joints: 'upper' (x), 'lower' (x) hold the same motion more than once"));
  CHECK_THAT(message, !Contains("'only'"));
}

TEST_CASE("More constraints than coordinates are redundant joints, too", "[analysis]") {
  Model model;
  test::add_body(model, dynamics::make_rigid_body("door", 1.0, 1.0));
  for (const double x : {0.2, 1.1}) {
    test::add_pin(model, x < 1.0 ? "upper" : "lower", test::add_marker(model, 0, {x, 0.0}),
                  test::add_marker(model, dynamics::kGround, {x, 0.0}));
  }
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(3);
  CHECK_THAT(error_message<support::InputError>([&] { dynamics::assemble_positions(model, q); }),
             Contains("redundant joints: 'upper' (x), 'lower' (x) hold the same motion more than once"));
}

TEST_CASE("A flexible body with too few modes for its pins is told to take more of them", "[analysis]") {
  // A beam pinned at three points: two of the constraints require it to bend and to stretch.
  const test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("beam", {0.0, 0.5, 1.0, 1.5, 2.0}, 1e7, 2e3, 6.0), 12);
  const auto assemble = [&](const std::vector<int>& modes, const std::vector<int>& nodes) {
    Model model;
    const int body = test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, modes));
    for (const int node : nodes) {
      const Eigen::Vector2d at = beam.superelement.node_positions.col(node);
      test::add_pin(model, "pin", test::add_node_marker(model, body, beam.superelement, node),
                    test::add_marker(model, dynamics::kGround, at));
    }
    dynamics::number_model(model);
    VectorXd q = VectorXd::Zero(model.num_coordinates);
    dynamics::assemble_positions(model, q);
  };
  const std::vector<int> all{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string message = error_message<support::InputError>([&] { assemble({1, 2, 3}, {1, 2, 4}); });
  CHECK_THAT(message, Contains("too few modes") && Contains("'beam'") && Contains("take more modes of it"));
  CHECK_THAT(message, Contains("'beam' has (3 of 12)"));
  // Likewise without any mode.
  CHECK_THAT(
      error_message<support::InputError>([&] {
        assemble({}, {1, 2, 4});
      }),
      Contains("too few modes") && Contains("'beam' has (0 of 12)") && Contains("take more modes of it"));
  CHECK_NOTHROW(assemble(all, {1, 2, 4}));
  // Two pins on one node stay redundant, whatever its modes.
  CHECK_THAT(error_message<support::InputError>([&] {
               assemble(all, {1, 4, 4});
             }),
             Contains("redundant joints"));
}

// Pins that a shift of 1 mm closes, and two pins further apart than the beam is long.
TEST_CASE("Assembly deforms a body only where it cannot close the joints as a rigid one", "[analysis]") {
  const test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("beam", {0.0, 0.5, 1.0, 1.5, 2.0}, 1e7, 2e3, 6.0), 12);
  const auto strain_energy = [&](const std::vector<int>& nodes, double shift, double stretch) {
    Model model;
    const int body = test::add_body(
        model,
        dynamics::make_flexible_body("beam", beam.superelement, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    for (const int node : nodes) {
      Eigen::Vector2d at = beam.superelement.node_positions.col(node);
      at.x() = shift + (1.0 + stretch) * at.x();
      test::add_pin(model, "pin", test::add_node_marker(model, body, beam.superelement, node),
                    test::add_marker(model, dynamics::kGround, at));
    }
    dynamics::number_model(model);
    VectorXd q = VectorXd::Zero(model.num_coordinates);
    dynamics::assemble_positions(model, q);
    return 0.5 * q.tail(12).dot(beam.superelement.stiffness.topLeftCorner(12, 12) * q.tail(12));
  };
  CHECK(strain_energy({0}, 1e-3, 0.0) < 1e-6);
  CHECK(strain_energy({0, 4}, 1e-3, 0.0) < 1e-6);
  // It is at least that of a uniform stretch, 2 m · EA/2 · ε².
  CHECK(strain_energy({0, 4}, 0.0, 1e-3) >= 10.0 * (1.0 - 1e-6));
}

// A block at rest on the end of a beam that moves along its axis: both move on as rigid bodies.
TEST_CASE("Modes take part in the start only where bodies cannot follow as rigid ones", "[analysis]") {
  const test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("beam", {0.0, 0.5, 1.0, 1.5, 2.0}, 1e7, 2e3, 6.0), 12);
  Model model;
  const int body = test::add_body(
      model,
      dynamics::make_flexible_body("beam", beam.superelement, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  const int block = test::add_body(model, dynamics::make_rigid_body("block", 30.0, 1.0));
  test::add_pin(model, "pin", test::add_node_marker(model, body, beam.superelement, 4),
                test::add_marker(model, block, {0.0, 0.0}));
  dynamics::number_model(model);
  VectorXd q = VectorXd::Zero(model.num_coordinates);
  q.segment<2>(model.bodies[1].first_coordinate) = beam.superelement.node_positions.col(4);
  VectorXd v = VectorXd::Zero(model.num_coordinates);
  v[0] = 5.0;
  VectorXd hit = v;
  dynamics::project_velocities(model, 0.0, q, hit);
  CHECK(hit.segment(3, 12).norm() > 1.0);
  dynamics::project_velocities(model, 0.0, q, v, dynamics::ModalRates::kIfNecessary);
  CHECK(v.segment(3, 12).norm() < 1e-4);  // kg^½ m/s
  CHECK(v[0] > 0.5);
  CHECK(v[model.bodies[1].first_coordinate] == Approx(v[0]).epsilon(1e-4));
}

TEST_CASE("Velocities are projected on the joints with the least change in the mass metric", "[analysis]") {
  const Model model = make_four_bar(1.0);
  VectorXd q = rough_four_bar();
  dynamics::assemble_positions(model, q);
  const VectorXd wanted = test::RandomNumbers(13).vector(9, 2.0);
  VectorXd v = wanted;
  const dynamics::VelocityReport report = dynamics::project_velocities(model, 0.0, q, v);
  double largest_change = 0.0;
  for (int i = 0; i < 9; ++i) {
    largest_change = std::max(largest_change, std::abs(v[i] - wanted[i]) / model.coordinate_scale(i));
  }
  CHECK(report.largest_change == largest_change);
  CHECK_FALSE(report.coordinate.empty());
  dynamics::SystemTerms terms(model);
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  terms.update_mass();
  CHECK((terms.jacobian().dense() * v).norm() < 1e-12 * v.norm());
  // Least: the change is orthogonal, in the mass metric, to every velocity that the joints allow.
  VectorXd mass_change(9);
  for (std::size_t b = 0; b < 3; ++b) {
    const auto first = static_cast<Eigen::Index>(3 * b);
    mass_change.segment<3>(first) = terms.mass(b) * (v - wanted).segment<3>(first);
  }
  const VectorXd allowed = terms.jacobian().dense().fullPivLu().kernel().col(0);
  CHECK(std::abs(allowed.dot(mass_change)) < 1e-11 * allowed.norm() * mass_change.norm());
  // A velocity that satisfies the joints stays
  VectorXd again = v;
  CHECK(dynamics::project_velocities(model, 0.0, q, again).largest_change < 1e-12);
  CHECK((again - v).norm() < 1e-13 * v.norm());
}
