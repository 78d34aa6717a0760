#include "dynamics/input/vehicle.h"

#include <filesystem>
#include <fstream>

#include "dynamics/bodies/marker.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"
#include "tests/dynamics/input/lumped_superelement.h"

using namespace sprung;
using test::cart_text;
using test::input_error_of;
using test::read_cart;
using test::with_change;

namespace {

std::string error_of_cart(const std::string& old_part, const std::string& new_part) {
  return input_error_of([&] { read_cart(with_change(cart_text(), old_part, new_part)); });
}

}  // namespace

TEST_CASE("A vehicle file is read as it is written") {
  const dynamics::Vehicle cart = read_cart(cart_text());
  CHECK(cart.name == "cart");
  CHECK(cart.text == cart_text());
  CHECK(cart.direction == 1.0);
  CHECK(cart.gravity == Eigen::Vector2d(0.5, -9.0));
  REQUIRE(cart.bodies.size() == 2);
  CHECK(cart.bodies[0].superelement == "frame");
  CHECK(cart.bodies[0].position == Eigen::Vector2d(2.0, 1.0));
  CHECK(cart.bodies[0].angle == 0.3);
  CHECK(cart.bodies[1].mass == 4.0);
  CHECK(cart.bodies[1].inertia == 0.7);
  CHECK(cart.bodies[1].angle == 0.0);
  CHECK(cart.superelements.size() == 1);
  CHECK(cart.superelement_of(cart.bodies[0])->num_modes() == 4);
  CHECK(cart.superelement_of(cart.bodies[1]) == nullptr);
  REQUIRE(cart.joints.size() == 1);
  CHECK(cart.joints[0].kind == "revolute");
  CHECK(cart.joints[0].location.line == 25);
  REQUIRE(cart.forces.size() == 2);
  CHECK(cart.forces[0].points[1].name == "ground.peg");
  CHECK(cart.forces[1].on_road);
  CHECK(cart.monitor[1].name == "arm.tip");
}

TEST_CASE("By default modes are judged by points and moments, else by what the file names") {
  const dynamics::JudgedQuantities standard = read_cart(cart_text()).judged;
  CHECK((standard.points && standard.moments));
  CHECK((!standard.forces && !standard.reactions));
  const auto with_judge = [](const std::string& list) {
    return with_change(cart_text(), "[bodies.frame]", "[modes]\njudge = " + list + "\n[bodies.frame]");
  };
  const dynamics::JudgedQuantities chosen = read_cart(with_judge("[\"reactions\", \"moments\"]")).judged;
  CHECK((chosen.reactions && chosen.moments));
  CHECK((!chosen.points && !chosen.forces));

  const auto error_of = [&](const std::string& list) {
    return input_error_of([&] { read_cart(with_judge(list)); });
  };
  CHECK_THAT(error_of("[\"points\", \"moment\"]"), Contains(": error: 'modes.judge.1' must be one of ") &&
                                                       Contains("\"points\"") && Contains("\"reactions\"") &&
                                                       Contains("got a string \"moment\"") &&
                                                       Contains("did you mean"));
  CHECK_THAT(error_of("[\"forces\", \"forces\"]"), Contains("'modes.judge.1' names \"forces\" twice"));
  CHECK_THAT(error_of("[]"), Contains("'modes.judge' must name at least one of"));
  CHECK_THAT(error_of("[]\njudges = 1"), Contains("unknown key 'judges' in 'modes'"));
}

TEST_CASE("By default gravity is the standard one, and every body's origin is monitored") {
  std::string text = with_change(cart_text(), "gravity = [0.5, -9.0]\n", "");
  text = with_change(text, "monitor = [\"frame.seat\", \"arm.tip\"]\n", "");
  const dynamics::Vehicle cart = read_cart(text);
  CHECK(cart.gravity == Eigen::Vector2d(0.0, -9.80665));
  REQUIRE(cart.monitor.size() == 2);
  CHECK(cart.monitor[0].name == "frame.origin");
  CHECK(cart.monitor[1].name == "arm.origin");
}

TEST_CASE(
    "The points of a vehicle are origins, centres of mass, named nodes, given points and the ground's") {
  const std::vector<dynamics::VehiclePoint> points = dynamics::list_points(read_cart(cart_text()));
  const std::vector<std::string> expected{
      "frame.origin", "frame.center_of_mass", "frame.left", "frame.right", "frame.top",  "frame.seat",
      "arm.origin",   "arm.center_of_mass",   "arm.tip",    "arm.root",    "ground.peg", "ground.origin"};
  CHECK(dynamics::point_names(read_cart(cart_text())) == expected);
  // Σ m r / Σ m of the frame's four point masses.
  const Eigen::Vector2d center((2.0 * -1.2 + 4.0 * 1.3 + 1.5 * 0.2) / 10.5,
                               (2.0 * 0.1 + 4.0 * -0.2 + 1.5 * 0.8) / 10.5);
  CHECK((points[1].p_BP - center).norm() < 1e-15);
  CHECK((points[5].p_BP - Eigen::Vector2d(0.3, 1.2)).norm() < 1e-15);
  CHECK(points[5].offset == Eigen::Vector2d(0.1, 0.4));
  CHECK(points[10].body == dynamics::kGround);
}

TEST_CASE("Keys that are missing, unknown or of the wrong type are refused at their place") {
  CHECK(error_of_cart("name = \"cart\"\n", "") == "cart.toml: error: missing key 'name'");
  CHECK(error_of_cart("gravity =", "gravty =") ==
        "cart.toml:3:1: error: unknown key 'gravty' (did you mean 'gravity'?)");
  CHECK(error_of_cart("\"+x\"", "\"x\"") ==
        "cart.toml:2:11: error: 'heading' must be one of \"+x\", \"-x\"; got a string \"x\" (did you mean "
        "'+x'?)");
  CHECK(error_of_cart("[0.5, -9.0]", "[0.5]") ==
        "cart.toml:3:11: error: 'gravity' must be an array of 2 numbers [m/s²], got an array of 1");
  CHECK(error_of_cart("[bodies.arm]\nmass", "[bodies.arm]\nmas")
            .starts_with("cart.toml:13:1: error: missing key 'mass' in 'bodies.arm'"));
  CHECK(error_of_cart("inertia = 0.7", "inertia = \"big\"") ==
        "cart.toml:15:11: error: 'bodies.arm.inertia' must be a number [kg·m²], got a string \"big\"");
  CHECK(error_of_cart("peg = [9.0, 0.2]", "peg = 9.0") ==
        "cart.toml:22:7: error: 'ground.points.peg' must be an array of 2 numbers [m], got a number 9.0");
  CHECK(error_of_cart("[ground.points]", "[ground]") ==
        "cart.toml:21:1: error: missing key 'points' in 'ground'");
  CHECK(error_of_cart("b = \"arm.root\"", "b = \"arm.root\"\nstiffness = 3.0") ==
        "cart.toml:29:1: error: unknown key 'stiffness' in 'joints.hinge' (known keys: name, type, a, b)");
}

TEST_CASE("Numbers that no body can have are refused with their unit") {
  CHECK(error_of_cart("mass = 4.0", "mass = -4.0") ==
        "cart.toml:14:8: error: 'bodies.arm.mass' must be ≥ 0 kg, got -4");
  CHECK(error_of_cart("mass = 4.0", "mass = nan") ==
        "cart.toml:14:8: error: 'bodies.arm.mass' must be a finite number [kg], got nan");
  CHECK(error_of_cart("inertia = 0.7", "inertia = -0.1") ==
        "cart.toml:15:11: error: 'bodies.arm.inertia' must be ≥ 0 kg·m², got -0.1");
  // Outside of the allowed range, or too far from the other body's 5 kg.
  CHECK(error_of_cart("mass = 4.0", "mass = 1e308") ==
        "cart.toml:14:8: error: 'bodies.arm.mass' must be ≤ 1e+30 kg, got 1e+308");
  CHECK(error_of_cart("inertia = 0.7", "inertia = 1e-320") ==
        "cart.toml:15:11: error: 'bodies.arm.inertia' must be ≥ 1e-30 and ≤ 1e+30 kg·m², got 1e-320");
  CHECK(error_of_cart("inertia = 0.7", "inertia = 7e19") ==
        "cart.toml:15:11: error: 'bodies.arm.inertia' is 7e+19 kg·m², which for a mass of 4 kg is a radius "
        "of gyration of 4.1833e+09 m; expected 1e-09 to 1e+09 m");
  CHECK(error_of_cart("mass = 4.0", "mass = 4e-25")
            .starts_with("cart.toml:14:8: error: 'bodies.arm.mass' is 4e-25 kg, where half of the bodies "
                         "have at least "));
  CHECK(error_of_cart("position = [3.5, 0.9]", "position = [inf, 0.9]") ==
        "cart.toml:16:13: error: 'bodies.arm.position.0' must be a finite number [m], got inf");
  CHECK(error_of_cart("free_length = 5.5", "free_length = 0.0") ==
        "cart.toml:36:15: error: 'forces.rope.free_length' must be > 0 m, got 0");
  CHECK(error_of_cart("multiplicity = 3", "multiplicity = 0") ==
        "cart.toml:35:16: error: 'forces.rope.multiplicity' must be > 0 and ≤ 1000000, got 0");
}

TEST_CASE("A body is either a superelement or mass and inertia") {
  CHECK(error_of_cart("superelement = \"frame\"", "superelement = \"frame\"\nmass = 10.5") ==
        "cart.toml:8:8: error: 'bodies.frame.mass' must be left out: the superelement has the body's mass "
        "and inertia");
  CHECK(error_of_cart("mass = 4.0\ninertia = 0.7\n", "") ==
        "cart.toml:13:1: error: 'bodies.arm' must have either 'mass' and 'inertia', or a 'superelement'");
  CHECK(error_of_cart("mass = 4.0\n", "") == "cart.toml:13:1: error: missing key 'mass' in 'bodies.arm'");
}

TEST_CASE("A vehicle without bodies is refused") {
  const auto read = [] { read_cart("name = \"nothing\"\nheading = \"-x\"\n[bodies]\n"); };
  CHECK(input_error_of(read) == "cart.toml:3:1: error: 'bodies' must have at least one body");
}

TEST_CASE("Names are bare words, unique, and not those that exist already") {
  CHECK(
      error_of_cart("[bodies.arm]\n", "[bodies.\"left arm\"]\n") ==
      "cart.toml:13:1: error: the name of a body must be letters, digits, '_' and '-' alone, got 'left arm'");
  CHECK(
      error_of_cart("tip = [0.6, -0.1]", "\"tip.1\" = [0.6, -0.1]") ==
      "cart.toml:18:11: error: the name of a point must be letters, digits, '_' and '-' alone, got 'tip.1'");
  CHECK(error_of_cart("name = \"hinge\"", "name = \"front/hinge\"") ==
        "cart.toml:25:8: error: the name of a joint must be letters, digits, '_' and '-' alone, got "
        "'front/hinge'");
  CHECK(
      error_of_cart("tip = [0.6, -0.1]", "origin = [0.6, -0.1]") ==
      "cart.toml:18:10: error: 'bodies.arm.points.origin' has a name that every body has already, 'origin'");
  CHECK(error_of_cart("seat = {", "left = {") ==
        "cart.toml:11:8: error: point 'left' has the name of a node of superelement 'frame'");
  CHECK(error_of_cart("name = \"wheel\"", "name = \"rope\"") ==
        "cart.toml:43:8: error: there is a force 'rope' already, in line 31");
  const std::string ground = with_change(cart_text(), "[bodies.arm]\n", "[bodies.ground]\n");
  CHECK(input_error_of(
            [&] { read_cart(with_change(ground, "[bodies.arm.points]", "[bodies.ground.points]")); }) ==
        "cart.toml:13:1: error: 'bodies.ground' cannot be a body: 'ground' is the world, which never moves");
  const std::string joint =
      "[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\na = \"frame.top\"\nb = \"arm.tip\"\n\n";
  CHECK(error_of_cart("[[forces]]\nname = \"rope\"", joint + "[[forces]]\nname = \"rope\"") ==
        "cart.toml:31:8: error: there is a joint 'hinge' already, in line 25");
}

TEST_CASE("A reference to a missing point gets the nearest name") {
  CHECK(error_of_cart("a = \"frame.right\"", "a = \"frane.right\"") ==
        "cart.toml:27:5: error: 'frane.right' names no body of the vehicle: there is no 'frane' (did you "
        "mean 'frame'?)");
  CHECK(error_of_cart("a = \"frame.right\"", "a = \"frame.rigth\"") ==
        "cart.toml:27:5: error: 'frame' has no point 'rigth' (did you mean 'right'?)");
  CHECK(error_of_cart("a = \"frame.right\"", "a = \"frame.gearbox\"") ==
        "cart.toml:27:5: error: 'frame' has no point 'gearbox'; it has origin, center_of_mass, left, "
        "right, top, seat");
  CHECK(error_of_cart("a = \"frame.right\"", "a = \"frame\"") ==
        "cart.toml:27:5: error: 'joints.hinge.a' must be a point \"body.point\" or \"ground.point\", got "
        "\"frame\"");
  CHECK(error_of_cart("b = \"ground.peg\"", "b = \"ground.pg\"") ==
        "cart.toml:34:5: error: 'ground' has no point 'pg' (did you mean 'peg'?)");
  CHECK(error_of_cart("wheel = \"frame.left\"", "wheel = \"frame.lift\"") ==
        "cart.toml:45:9: error: 'frame' has no point 'lift' (did you mean 'left'?)");
  CHECK(error_of_cart("[\"frame.seat\", ", "[\"frame.seet\", ") ==
        "cart.toml:4:12: error: 'frame' has no point 'seet' (did you mean 'seat'?)");
  CHECK(error_of_cart("node = \"top\"", "node = \"tap\"") ==
        "cart.toml:11:8: error: superelement 'frame' has no named node 'tap' (did you mean 'top'?)");
}

TEST_CASE("Points are given by nodes on superelements, and by positions elsewhere") {
  CHECK(error_of_cart("seat = { node = \"top\", offset = [0.1, 0.4] }", "seat = [0.1, 0.4]") ==
        "cart.toml:11:8: error: 'bodies.frame.points.seat' must be { node = \"…\", offset = [x, y] }: the "
        "body is a superelement, whose points move with its nodes");
  CHECK(error_of_cart("tip = [0.6, -0.1]", "tip = { node = \"top\" }") ==
        "cart.toml:18:7: error: 'bodies.arm.points.tip' must be a position [x, y] [m]: only a body with a "
        "superelement has nodes");
  CHECK(error_of_cart("offset =", "ofset =") ==
        "cart.toml:11:24: error: unknown key 'ofset' in 'bodies.frame.points.seat' (did you mean 'offset'?)");
}

TEST_CASE("A joint joins two bodies") {
  CHECK(error_of_cart("a = \"frame.right\"", "a = \"arm.tip\"") ==
        "cart.toml:28:5: error: joint 'hinge' must join two bodies, 'arm.tip' and 'arm.root' are both on "
        "'arm'");
}

TEST_CASE("A kind of joint or force that is not known is refused") {
  CHECK_THAT(error_of_cart("type = \"revolute\"", "type = \"revolut\""),
             Contains("cart.toml:26:8: error: 'joints.hinge.type' must be one of \"revolute\", ") &&
                 Contains("; got a string \"revolut\" (did you mean 'revolute'?)"));
  CHECK_THAT(error_of_cart("type = \"tyre\"", "type = \"tire\""),
             Contains("cart.toml:44:8: error: 'forces.wheel.type' must be one of \"spring-damper\", ") &&
                 Contains("; got a string \"tire\" (did you mean 'tyre'?)"));
}

TEST_CASE("A force along a line of no length is refused") {
  CHECK(error_of_cart("peg = [9.0, 0.2]", "peg = [4.1, 0.8]") ==
        "cart.toml:31:8: error: force 'rope' acts along the line between 'arm.tip' and 'ground.peg', which "
        "are at one place (4.1 m, 0.8 m)");
}

TEST_CASE("A missing superelement is reported where the vehicle file names it") {
  CHECK(error_of_cart("superelement = \"frame\"", "superelement = \"frome\"") ==
        "cart.toml:7:16: error: body 'frame' names superelement 'frome', but there is no file "
        "superelements/frome.h5 (did you mean 'frame'?); build it with `sprung-reduce build` or give its "
        "folder with --superelements");
  CHECK(error_of_cart("superelement = \"frame\"", "superelement = \"../frame\"") ==
        "cart.toml:7:16: error: the name of a superelement must be letters, digits, '_' and '-' alone, got "
        "'../frame'");
}

TEST_CASE("A superelement file that cannot be used is named") {
  const std::filesystem::path folder = "foreign";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "frame.h5") << "not HDF5";
  const support::TomlDocument document = support::TomlDocument::parse(cart_text(), "cart.toml");
  const std::string message = input_error_of([&] { dynamics::read_vehicle(document, folder); });
  CHECK(message.find("foreign/frame.h5: error: ") == 0);
}

TEST_CASE("A node may be called origin only where it is the origin") {
  test::LumpedBody body{.name = "frame",
                        .nodes = {{"origin", {0.0, 0.0}, 3.0},
                                  {"left", {-1.2, 0.1}},
                                  {"right", {1.3, -0.2}},
                                  {"top", {0.2, 0.8}}},
                        .frequencies = {5.0}};
  const support::TomlDocument document = support::TomlDocument::parse(cart_text(), "cart.toml");
  test::write_lumped_superelement(body, "origin");
  CHECK(dynamics::point_names(dynamics::read_vehicle(document, "origin")).size() == 12);
  body.nodes.push_back({"center_of_mass", {0.3, 0.1}});
  test::write_lumped_superelement(body, "origin");
  CHECK(input_error_of([&] { dynamics::read_vehicle(document, "origin"); }) ==
        "cart.toml:7:16: error: superelement 'frame' has a node named 'center_of_mass' at (0.3, 0.1) m, but "
        "every body has a point of that name; give the node another in its design");
}
