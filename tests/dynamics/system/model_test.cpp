#include "dynamics/system/model.h"

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
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
