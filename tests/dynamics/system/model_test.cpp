#include "dynamics/system/model.h"

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using Eigen::VectorXd;

namespace {

// A rigid body, a frame with the given modes, and a rigid body behind it; a pin and a spring.
Model make_model(const std::vector<int>& modes) {
  static const test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 6);
  Model model;
  test::add_body(model, dynamics::make_rigid_body("cart", 5.0, 2.0));
  test::add_body(model, dynamics::make_flexible_body("frame", frame.superelement, modes));
  test::add_body(model, dynamics::make_rigid_body("bob", 1.0, 0.5));
  test::add_marker(model, 0, {0.0, 0.3}, "hook");
  test::add_marker(model, 2, {-1.0, 1.5}, "eye");
  test::add_marker(model, dynamics::kGround, {30.0, 40.0}, "post");
  test::add_node_marker(model, 1, frame.superelement, 2);
  test::add_pin(model, "hinge", 0, 3);
  test::add_pin(model, "eye", 1, 3);
  test::add_spring(model, "spring", 0, 2, 1.0, 100.0, 0.0);
  test::add_spring(model, "other", 1, 2, 1.0, 100.0, 0.0);
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("Coordinates, constraints and branches are numbered in the order of the parts", "[system]") {
  const Model model = make_model({1, 4});
  CHECK(model.num_coordinates == 3 + 5 + 3);
  CHECK(model.bodies[1].first_coordinate == 3);
  CHECK(model.bodies[2].first_coordinate == 8);
  CHECK(model.num_constraints == 4);
  CHECK(model.joint_rows == std::vector<int>{0, 2});
  CHECK(model.num_freedoms() == 7);
  CHECK(model.num_branches == 4);  // piece of spring and of damper, each
  CHECK(model.force_branches == std::vector<int>{0, 2});
}

TEST_CASE("Coordinates have names and natural sizes", "[system]") {
  const Model model = make_model({1, 4});
  CHECK(model.coordinate_name(0) == "cart.x");
  CHECK(model.coordinate_name(4) == "frame.y");
  CHECK(model.coordinate_name(5) == "frame.angle");
  CHECK(model.coordinate_name(6) == "frame.mode 1");
  CHECK(model.coordinate_name(7) == "frame.mode 4");
  CHECK(model.coordinate_name(10) == "bob.angle");
  CHECK_THROWS_AS(model.coordinate_name(11), std::invalid_argument);
  // The furthest point from its body's frame is the eye; points of the ground do not count.
  const double length = std::hypot(1.0, 1.5);
  CHECK(model.length_scale == Approx(length).epsilon(1e-15));
  CHECK(model.coordinate_scale(3) == model.length_scale);
  CHECK(model.coordinate_scale(5) == 1.0);
  CHECK(model.coordinate_scale(7) * model.bodies[1].mode_scale[1] == Approx(length).epsilon(1e-14));
}

TEST_CASE("Bodies and markers are found by name", "[system]") {
  const Model model = make_model({1});
  CHECK(model.find_body("frame") == 1);
  CHECK(model.find_body("fram") == -1);
  CHECK(model.find_marker("bob.eye") == 1);
  CHECK(model.find_marker("ground.post") == 2);
  CHECK(model.find_marker("eye") == -1);
}

TEST_CASE("A state is carried over to other active modes: common modes keep theirs, new ones are at rest",
          "[system]") {
  const Model from = make_model({1, 3, 4}), to = make_model({2, 3, 4, 6});
  test::RandomNumbers random(5);
  dynamics::State state = test::make_state(from, random.vector(from.num_coordinates, 1.0),
                                           random.vector(from.num_coordinates, 1.0));
  state.time = 2.5;
  state.branches = {0, 1, 2, 3};
  const dynamics::State carried = dynamics::carry_over(from, state, to);
  CHECK(carried.time == 2.5);
  CHECK(carried.branches == state.branches);
  for (const auto& [before, after] : {std::pair{state.q, carried.q}, {state.v, carried.v}}) {
    REQUIRE(after.size() == to.num_coordinates);
    CHECK(after.head(6) == before.head(6));              // cart and the frame's frame
    CHECK(after[6] == 0.0);                              // mode 2 is new
    CHECK(after.segment(7, 2) == before.segment(7, 2));  // modes 3 and 4
    CHECK(after[9] == 0.0);                              // mode 6 is new
    CHECK(after.tail(3) == before.tail(3));              // bob
  }
}

TEST_CASE("Carrying a state over and back changes nothing where all modes are kept", "[system]") {
  const Model few = make_model({2}), many = make_model({1, 2, 5});
  test::RandomNumbers random(6);
  const dynamics::State state =
      test::make_state(few, random.vector(few.num_coordinates, 1.0), random.vector(few.num_coordinates, 1.0));
  const dynamics::State back = dynamics::carry_over(many, dynamics::carry_over(few, state, many), few);
  CHECK(back.q == state.q);
  CHECK(back.v == state.v);
}
