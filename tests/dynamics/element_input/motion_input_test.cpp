#include "dynamics/element_input/motion_input.h"

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::RelativeCoordinate;
using test::cart_text;
using test::input_error_of;
using test::read_cart;

namespace {

// The cart with a weld and one motion more, which begins in line 50.
std::string cart_with(const std::string& motion) {
  return cart_text() +
         "\n[[joints]]\nname = \"weld\"\ntype = \"fixed\"\na = \"ground.peg\"\nb = \"arm.tip\"\n\n" +
         "[[motions]]\n" + motion;
}

std::string error_of(const std::string& motion) {
  const std::string message = input_error_of([&] { read_cart(cart_with(motion)); });
  return message.substr(message.find("error: "));
}

}  // namespace

TEST_CASE("Motions drive a joint's coordinate or a point's") {
  const dynamics::Vehicle of_joint = read_cart(cart_with("name = \"m\"\njoint = \"hinge\"\nfunction = 0.4"));
  REQUIRE(of_joint.motions.size() == 1);
  CHECK(of_joint.motions[0].a.name == "frame.right");
  CHECK(of_joint.motions[0].b.name == "arm.root");
  CHECK(of_joint.motions[0].coordinate.is_angle());
  const dynamics::Vehicle of_point = read_cart(cart_with(
      "name = \"m\"\npoint = \"arm.tip\"\ncoordinate = \"y\"\nfunction = { polynomial = [0.1, 0.2] }"));
  CHECK(of_point.motions[0].a.name == "ground.origin");
  CHECK(of_point.motions[0].coordinate.kind() == RelativeCoordinate::Kind::kY);
  CHECK(of_point.motions[0].value.value(2.0) == Approx(0.5));
}

TEST_CASE("A table of a motion is smooth") {
  const dynamics::Vehicle cart = read_cart(cart_with(
      "name = \"m\"\njoint = \"hinge\"\nfunction = { table = [[0.0, 0.0], [1.0, 2.0], [2.0, 0.0]] }"));
  CHECK(cart.motions[0].value.rate(1.0) ==
        Approx(0.0).margin(1e-14));  // by symmetry; straight lines have a kink there
  CHECK(cart.motions[0].value.rate(0.0) == Approx(0.0).margin(1e-14));
}

TEST_CASE("Impossible motions are refused") {
  CHECK(error_of("name = \"m\"\njoint = \"hing\"\nfunction = 0.0") ==
        "error: 'motions.m.joint' names no joint of the vehicle, 'hing' (did you mean 'hinge'?)");
  CHECK(error_of("name = \"m\"\njoint = \"weld\"\nfunction = 0.0") ==
        "error: 'motions.m.joint' names a fixed joint, which has no coordinate to be driven");
  CHECK(error_of("name = \"m\"\nfunction = 0.0") ==
        "error: 'motions.m' must have either a 'joint', or a 'point' and its 'coordinate'");
  CHECK(
      error_of("name = \"m\"\njoint = \"hinge\"\npoint = \"arm.tip\"\ncoordinate = \"x\"\nfunction = 0.0") ==
      "error: 'motions.m' must have either a 'joint', or a 'point' and its 'coordinate', not several of "
      "them");
  CHECK(error_of("name = \"m\"\njoint = \"hinge\"\ncoordinate = \"x\"\nfunction = 0.0") ==
        "error: 'motions.m.coordinate' must be left out: the joint has its own");
  CHECK(error_of("name = \"m\"\npoint = \"ground.peg\"\ncoordinate = \"x\"\nfunction = 0.0") ==
        "error: motion 'm' moves the ground");
  CHECK(error_of("name = \"hinge\"\njoint = \"hinge\"\nfunction = 0.0") ==
        "error: motion 'hinge' has the name of a joint");
  CHECK(error_of("name = \"m\"\njoint = \"hinge\"\nfunction = \"fast\"") ==
        "error: 'motions.m.function' must be a number [rad] or a function of time");
}

TEST_CASE("Impossible functions of time are refused") {
  const auto error = [](const std::string& function) {
    return error_of("name = \"m\"\njoint = \"hinge\"\nfunction = " + function);
  };
  CHECK(error("{ step = { before = 0.0, after = 1.0, start = 2.0, end = 1.0 } }") ==
        "error: 'motions.m.function.step.end' must come after the start of 2 s, got 1 s");
  CHECK(error("{ harmonic = { amplitude = 1.0, frequency = 0.0 } }") ==
        "error: 'motions.m.function.harmonic.frequency' must be > 0 Hz, got 0");
  CHECK(error("{ polynomial = [] }") ==
        "error: 'motions.m.function.polynomial' must have at least one coefficient [rad/s^k]");
  CHECK(error("{ table = [[0.0, 1.0], [0.0, 2.0]] }") ==
        "error: 'motions.m.function.table.1' must ascend: 0 s comes after 0 s");
  CHECK(error("{}") ==
        "error: 'motions.m.function' must have one of 'polynomial', 'harmonic', 'table', 'history', 'step', "
        "'sum', "
        "'product' and 'pieces'");
}
