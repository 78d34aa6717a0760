#include "dynamics/input/make_model.h"

#include <cmath>
#include <numbers>

#include "dynamics/road/flat_road.h"
#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;

namespace {

const dynamics::FlatRoad kFlat;
const dynamics::PlacedRoad kRoad{.road = &kFlat};

const dynamics::Marker& find(const dynamics::Model& model, const std::string& name) {
  const int index = model.find_marker(name);
  REQUIRE(index >= 0);
  return model.markers[static_cast<std::size_t>(index)];
}

}  // namespace

TEST_CASE("A model has the vehicle's bodies, markers, joints and forces in the file's order") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::Model model = dynamics::make_model(cart, {{"frame", {1, 2, 4}}}, kRoad);
  REQUIRE(model.bodies.size() == 2);
  CHECK(model.bodies[0].name == "frame");
  CHECK(model.bodies[0].mode_numbers == std::vector<int>{1, 2, 4});
  CHECK(model.bodies[1].mass == 4.0);
  CHECK(model.gravity == Eigen::Vector2d(0.5, -9.0));
  CHECK(model.num_coordinates == 9);
  CHECK(model.num_constraints == 2);
  std::vector<std::string> names;
  for (const dynamics::Marker& marker : model.markers) names.push_back(marker.name);
  CHECK(names == dynamics::point_names(cart));
  REQUIRE(model.joints.size() == 1);
  CHECK(model.joints[0]->name == "hinge");
  CHECK(model.joints[0]->location.line == 25);
  CHECK(model.markers[static_cast<std::size_t>(model.joints[0]->marker_a)].name == "frame.right");
  CHECK(model.markers[static_cast<std::size_t>(model.joints[0]->marker_b)].name == "arm.root");
  REQUIRE(model.forces.size() == 2);
  CHECK(model.forces[0]->kind() == "spring-damper");
  CHECK(model.forces[1]->kind() == "tyre");
}

TEST_CASE("A rigid model of the same vehicle has the superelement's mass and its markers without modes") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::Model model = dynamics::make_model(cart, {}, kRoad);
  CHECK(model.num_coordinates == 6);
  CHECK(model.bodies[0].mass == 10.5);  // 3 + 2 + 4 + 1.5 kg
  CHECK(find(model, "frame.seat").Phi.cols() == 0);
  CHECK(find(model, "frame.seat").p_BP == dynamics::list_points(cart)[5].p_BP);
  const dynamics::Marker& peg = find(model, "ground.peg");
  CHECK(peg.body == dynamics::kGround);
  CHECK(peg.p_BP == Eigen::Vector2d(9.0, 0.2));
  CHECK(peg.Phi.cols() == 0);
}

TEST_CASE("Markers move with the active modes: nodes by their shapes, offsets with the node's rotation") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const Eigen::MatrixXd& shapes = cart.superelements.at("frame").shapes;
  const dynamics::Model model = dynamics::make_model(cart, {{"frame", {2, 3}}}, kRoad);
  const int top = 3;  // fourth node of the frame
  for (int k = 0; k < 2; ++k) {
    const int column = k + 1;  // modes 2 and 3
    const double u = shapes(3 * top, column), w = shapes(3 * top + 1, column),
                 turn = shapes(3 * top + 2, column);
    CHECK(find(model, "frame.top").Phi.col(k).head<2>() == Eigen::Vector2d(u, w));
    CHECK(find(model, "frame.top").Phi(2, k) == turn);
    // The offset (0.1, 0.4) turned by +90° is (-0.4, 0.1).
    CHECK((find(model, "frame.seat").Phi.col(k).head<2>() - Eigen::Vector2d(u - 0.4 * turn, w + 0.1 * turn))
              .norm() < 1e-15);
    CHECK(find(model, "frame.seat").Phi(2, k) == turn);
    CHECK(find(model, "frame.origin").Phi.col(k).norm() == 0.0);
  }
}

TEST_CASE(
    "The centre-of-mass marker is where the point masses have their centre, also while the body is bent") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::Model model = dynamics::make_model(cart, {{"frame", {1, 2, 3, 4}}}, kRoad);
  Eigen::VectorXd q = dynamics::make_start_positions(model, cart);
  q.segment<4>(3) << 0.11, -0.23, 0.31, 0.17;
  dynamics::SystemTerms terms(model);
  terms.update_positions(0.0, q);
  const auto at = [&](const char* name) {
    return terms.markers()[static_cast<std::size_t>(model.find_marker(name))].r;
  };
  const Eigen::Vector2d expected =
      (3.0 * at("frame.origin") + 2.0 * at("frame.left") + 4.0 * at("frame.right") + 1.5 * at("frame.top")) /
      10.5;
  CHECK((at("frame.center_of_mass") - expected).norm() < 1e-14);
}

TEST_CASE("Damping is the superelement's, or 2 ζ ω m of the given ratios") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::ModeSelection selection{{"frame", {1, 3}}};
  const auto damping_of = [&](const dynamics::ModalDamping& damping) {
    return dynamics::make_model(cart, selection, kRoad, damping).bodies[0].damping;
  };
  // Modes at 5 and 12 Hz, mass-normalised, 1 % of critical in the file.
  const Eigen::Vector2d omega = 2.0 * std::numbers::pi * Eigen::Vector2d(5.0, 12.0);
  const auto expect = [&](double first, double second) {
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, 2);
    expected.diagonal() << 2.0 * first * omega[0], 2.0 * second * omega[1];
    return expected;
  };
  CHECK(damping_of({}).isApprox(expect(0.01, 0.01), 1e-12));
  CHECK(damping_of({{"frame", {0.05}}}).isApprox(expect(0.05, 0.05), 1e-12));
  CHECK(damping_of({{"frame", {0.0, 0.3}}}).isApprox(expect(0.0, 0.3), 1e-12));
}

TEST_CASE("The leading position is the foremost wheel's along the heading, or the foremost body's") {
  dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const auto leading = [&] {
    const dynamics::Model model = dynamics::make_model(cart, {}, kRoad);
    dynamics::SystemTerms terms(model);
    terms.update_positions(0.0, dynamics::make_start_positions(model, cart));
    return dynamics::find_leading_position(model, cart, terms.markers());
  };
  // The wheel is at (-1.2, 0.1) of the frame, which is at x = 2 and turned by 0.3 rad.
  const double wheel = 2.0 - 1.2 * std::cos(0.3) - 0.1 * std::sin(0.3);
  CHECK(leading() == Approx(wheel).epsilon(1e-14));
  cart.direction = -1.0;
  CHECK(leading() == Approx(-wheel).epsilon(1e-14));
  cart.forces.clear();
  CHECK(leading() == -2.0);
  cart.direction = 1.0;
  CHECK(leading() == 3.5);
}

TEST_CASE("A model is refused for wrong modes, damping or road, as the caller's mistake") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  CHECK_THROWS_WITH(dynamics::make_model(cart, {{"frome", {1}}}, kRoad),
                    "make_model: modes selected of 'frome', which is no body");
  CHECK_THROWS_WITH(dynamics::make_model(cart, {{"arm", {1}}}, kRoad),
                    "make_model: body 'arm' has no superelement, so no modes");
  CHECK_THROWS_WITH(dynamics::make_model(cart, {{"frame", {1, 2, 3}}}, kRoad, {{"frame", {0.1, 0.2}}}),
                    "make_model: damping of 'frame' must be 1 or 3 ratios, got 2");
  CHECK_THROWS_WITH(dynamics::make_model(cart, {}, {}), "make_model: force 'wheel' needs a road, got none");
}
