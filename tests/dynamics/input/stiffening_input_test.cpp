#include "dynamics/input/stiffening_input.h"

#include "dynamics/input/make_model.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

// The tests' cart; its frame's file is of version 1.
dynamics::Vehicle read_cart() {
  return test::read_cart(test::cart_text());
}

// The same with geometric stiffness of the first modes, all alike.
dynamics::Vehicle read_stiffening_cart(int num_modes) {
  dynamics::Vehicle cart = read_cart();
  reduce::Superelement& frame = cart.superelements.at("frame");
  const Eigen::MatrixXd K = Eigen::MatrixXd::Identity(num_modes, num_modes);
  frame.geometric_stiffness = reduce::GeometricStiffness{K, K, {K, K}, {}};
  frame.geometric_stiffness->point_loads.assign(frame.points.size(), {K, K, K});
  return cart;
}

dynamics::StiffenedBodies resolve(const std::string& line, const dynamics::ModeSelection& selection,
                                  const dynamics::Vehicle& vehicle) {
  const support::TomlDocument document = support::TomlDocument::parse("[stiffening]\n" + line, "run.toml");
  return dynamics::resolve_stiffening(dynamics::read_stiffening(document.root().at("stiffening").table()),
                                      selection, vehicle);
}

}  // namespace

TEST_CASE("Bodies with active modes stiffen where the run file says so") {
  const dynamics::Vehicle cart = read_stiffening_cart(4);
  const dynamics::ModeSelection selection{{"frame", {1, 2, 4}}};
  CHECK(resolve("frame = true", selection, cart) == dynamics::StiffenedBodies{"frame"});
  CHECK(resolve("frame = false", selection, cart).empty());
  CHECK(resolve("frame = true", {}, cart).empty());
  CHECK(resolve("", selection, cart).empty());
}

TEST_CASE("Impossible stiffening is refused") {
  const dynamics::ModeSelection selection{{"frame", {1, 2, 4}}};
  CHECK(input_error_of([&] { resolve("frame = true", selection, read_cart()); }) ==
        "run.toml:2:9: error: 'stiffening.frame' needs the geometric stiffness of superelement 'frame', "
        "whose file is of version 1 and has none; build it again from its design with sprung-reduce build");
  CHECK(input_error_of([&] { resolve("frame = true", selection, read_stiffening_cart(3)); }) ==
        "run.toml:2:9: error: 'stiffening.frame' cannot be true with mode 4: superelement 'frame' has "
        "geometric stiffness of its lowest 3 modes");
  CHECK(input_error_of([&] { resolve("arm = true", selection, read_cart()); }) ==
        "run.toml:2:7: error: 'stiffening.arm' is about the modes of body 'arm', which has no superelement");
  CHECK(input_error_of([&] { resolve("frame = 1", selection, read_cart()); }).find("run.toml:2:9: error:") ==
        0);
  // With stiffening off, an old file can be used.
  CHECK(resolve("frame = false", selection, read_cart()).empty());
}

TEST_CASE("Every point of a stiffened body has a second-order displacement, except its centre of mass") {
  const dynamics::Vehicle cart = read_stiffening_cart(4);
  const dynamics::FlatRoad flat;
  const auto make = [&](const dynamics::StiffenedBodies& stiffened) {
    return dynamics::make_model(cart, {{"frame", {1, 2, 4}}}, {.road = &flat}, {},
                                dynamics::MotionUse::kMoving, stiffened);
  };
  const dynamics::Model on = make({"frame"}), off = make({});
  CHECK(on.bodies[0].stiffening);
  CHECK_FALSE(off.bodies[0].stiffening);
  for (std::size_t i = 0; i < on.markers.size(); ++i) {
    const dynamics::Marker& marker = on.markers[i];
    CAPTURE(marker.name);
    CHECK(marker.has_second_order() == (marker.body == 0 && marker.name != "frame.center_of_mass"));
    CHECK_FALSE(off.markers[i].has_second_order());
    if (marker.has_second_order()) CHECK(marker.K[0].rows() == 3);
  }
}
