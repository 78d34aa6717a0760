#include "dynamics/element_input/joint_input.h"

#include "dynamics/joints/coordinate_joint.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::MarkerState;
using test::input_error_of;

namespace {

dynamics::JointDescription read(const std::string& rest) {
  const std::string text = "[[joints]]\nname = \"j\"\na = \"p.origin\"\nb = \"q.origin\"\n" + rest;
  const support::TomlDocument document = support::TomlDocument::parse(text, "j.toml");
  dynamics::HistoryFiles histories("");
  return dynamics::read_joint(document.root().at("joints").items().front().table(), histories);
}

std::string error_of(const std::string& rest) {
  return input_error_of([&] { read(rest); });
}

dynamics::JointVector residual_of(const std::string& rest, const MarkerState& b,
                                  const dynamics::JointPlace& place = {}, double time = 0.0) {
  dynamics::JointVector phi;
  dynamics::make_joint(read(rest), place)->calc_residual(MarkerState(), b, time, phi);
  return phi;
}

MarkerState marker(double x, double y, double angle) {
  MarkerState state;
  state.r = {x, y};
  state.angle = angle;
  return state;
}

}  // namespace

TEST_CASE("Joints are made as the file says") {
  const std::string slide = "type = \"translational\"\naxis = [0.0, 2.0]\n";
  CHECK(residual_of(slide, marker(0.3, 5.0, 0.4), {.angle = 0.1})[0] == Approx(-0.3));
  CHECK(residual_of(slide, marker(0.3, 5.0, 0.4), {.angle = 0.1})[1] == Approx(0.3));
  CHECK(residual_of(slide + "angle = 0.4", marker(0.3, 5.0, 0.4), {.angle = 0.1})[1] == 0.0);
  CHECK(residual_of("type = \"fixed\"", marker(0.0, 0.0, 0.4), {.angle = 0.4}).isZero(0.0));
  CHECK(residual_of("type = \"pin-in-slot\"\naxis = [1.0, 0.0]", marker(3.0, 0.2, 9.0))[0] == Approx(0.2));
  CHECK(residual_of("type = \"distance\"\nlength = 4.0", marker(3.0, 4.0, 0.0))[0] == Approx(1.0));
}

TEST_CASE("An axis may be of any length") {
  for (const char* axis : {"[0.0, 1e-300]", "[0.0, 1e30]"}) {
    CHECK(residual_of(std::string("type = \"pin-in-slot\"\naxis = ") + axis, marker(0.2, 3.0, 0.0))[0] ==
          Approx(-0.2));
  }
}

TEST_CASE("A driven length varies, or keeps its initial value for an equilibrium") {
  const std::string actuator = "type = \"distance\"\nlength = { polynomial = [4.0, 0.5] }";
  CHECK(residual_of(actuator, marker(3.0, 4.0, 0.0), {}, 2.0)[0] == Approx(0.0).margin(1e-15));
  CHECK(residual_of(actuator, marker(3.0, 4.0, 0.0), {.motions = dynamics::MotionUse::kHeld}, 2.0)[0] ==
        Approx(1.0));
}

TEST_CASE("Impossible joints are refused at their location") {
  CHECK(error_of("type = \"revolut\"") ==
        "j.toml:5:8: error: 'joints.j.type' must be one of \"revolute\", \"translational\", \"fixed\", "
        "\"distance\", \"pin-in-slot\"; got a string \"revolut\" (did you mean 'revolute'?)");
  CHECK(error_of("type = \"translational\"\naxis = [0.0, 0.0]") ==
        "j.toml:6:8: error: 'joints.j.axis' must be a direction [x, y], got [0, 0]");
  CHECK(error_of("type = \"pin-in-slot\"") == "j.toml:1:1: error: missing key 'axis' in 'joints.j'");
  CHECK(error_of("type = \"distance\"\nlength = 0.0") ==
        "j.toml:6:10: error: 'joints.j.length' must be > 0 m, got 0");
  CHECK(error_of("type = \"fixed\"\nangle = inf") ==
        "j.toml:6:9: error: 'joints.j.angle' must be a finite number [rad], got inf");
  CHECK(error_of("type = \"fixed\"\naxis = [1.0, 0.0]").starts_with("j.toml:6:1: error: unknown key 'axis'"));
}
