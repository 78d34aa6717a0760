#include "dynamics/element_input/force_input.h"

#include <array>
#include <cmath>

#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

constexpr double kFreeLength = 2.0;

dynamics::ForceDescription read(const std::string& text) {
  const support::TomlDocument document = support::TomlDocument::parse("[[forces]]\n" + text, "f.toml");
  dynamics::HistoryFiles histories("");
  return dynamics::read_force(document.root().at("forces").items().front().table(), histories);
}

std::string spring_damper(const std::string& laws) {
  return "name = \"s\"\ntype = \"spring-damper\"\na = \"p.origin\"\nb = \"q.origin\"\nfree_length = 2.0\n" +
         laws;
}

std::string tyre(const std::string& rest) {
  return "name = \"t\"\ntype = \"tyre\"\nwheel = \"p.origin\"\nradius = 0.5\n" + rest;
}

// Force channel of a spring-damper at this deflection and rate: markers on a line of general direction.
double force_of(const std::string& laws, double deflection, double rate) {
  const std::unique_ptr<dynamics::ForceElement> force =
      dynamics::make_force(read(spring_damper(laws)), std::array{0, 1}, {});
  const Eigen::Vector2d along(0.6, -0.8);
  std::array<dynamics::MarkerState, 2> markers;
  markers[0].r = {3.0, 4.0};
  markers[0].v = {-1.5, 0.5};
  markers[1].r = markers[0].r + (kFreeLength - deflection) * along;
  markers[1].v = markers[0].v - rate * along;
  std::array<double, 4> channels{};
  REQUIRE(force->channels()[3].name == "force");
  force->calc_channels({.markers = markers}, {}, channels);
  return channels[3];
}

// Force channel of a tyre at this penetration and rate, on flat ground.
double tyre_force_of(const std::string& rest, double penetration, double rate) {
  const dynamics::FlatRoad flat;
  const std::unique_ptr<dynamics::ForceElement> force =
      dynamics::make_force(read(tyre(rest)), std::array{0}, {.road = &flat});
  std::array<dynamics::MarkerState, 1> markers;
  markers[0].r = {7.0, 0.5 - penetration};
  markers[0].v = {2.0, -rate};
  std::array<int, 2> branches{};
  force->choose_branches({.markers = markers}, branches);
  std::array<double, 5> channels{};
  REQUIRE(force->channels()[0].name == "force");
  force->calc_channels({.markers = markers}, branches, channels);
  return channels[0];
}

std::string error_of(const std::string& text) {
  return input_error_of([&] { read(text); });
}

constexpr double kRounding = 1e-12;

}  // namespace

TEST_CASE("A spring's law is a polynomial or a table, times its multiplicity") {
  const std::string polynomial = "multiplicity = 3\nspring = { polynomial = [10.0, 200.0, 30.0] }";
  CHECK(force_of(polynomial, 0.3, 0.0) ==
        Approx(3.0 * (10.0 + 200.0 * 0.3 + 30.0 * 0.09)).epsilon(kRounding));
  const std::string table = "spring = { table = [[-0.1, -20], [0.0, 0.0], [0.2, 80.0]] }";
  CHECK(force_of(table, 0.05, 0.0) == Approx(20.0).epsilon(kRounding));
  CHECK(force_of(table, 0.3, 0.0) == Approx(120.0).epsilon(kRounding));
  CHECK(force_of(table, -0.2, 0.0) == Approx(-40.0).epsilon(kRounding));
}

TEST_CASE("A spring's length in equilibrium may be given in place of its free length") {
  const auto with_length = [](const std::string& value, const std::string& laws) {
    return "name = \"s\"\ntype = \"spring-damper\"\na = \"p.origin\"\nb = \"q.origin\"\nfree_length = " +
           value + "\n" + laws;
  };
  const std::string spring = "spring = { polynomial = [0.0, 100.0] }";
  CHECK(read(with_length("{ static = 0.4 }", spring)).static_length->length == 0.4);
  CHECK_FALSE(read(with_length("{ static = \"as-drawn\" }", spring)).static_length->length.has_value());
  CHECK_FALSE(read(with_length("0.4", spring)).static_length.has_value());
  CHECK(error_of(with_length("{ static = -0.4 }", spring)) ==
        "f.toml:6:26: error: 'forces.s.free_length.static' must be > 0 m, got -0.4");
  CHECK(error_of(with_length("{ static = 0.4 }", "damper = { coefficient = 3.0 }")) ==
        "f.toml:6:15: error: 'forces.s.free_length' can follow from the static length only where there is a "
        "'spring'");
}

TEST_CASE("Stops continue linearly from the spring's force where they begin") {
  const std::string laws =
      "spring = { polynomial = [0.0, 100.0, 50.0] }\n"
      "compression_stop = { deflection = 0.4, rate = 5000.0 }\nrebound_stop = { deflection = -0.2, rate = "
      "3000.0 }";
  CHECK(force_of(laws, 0.399, 0.0) == Approx(39.9 + 50.0 * 0.399 * 0.399).epsilon(kRounding));
  CHECK(force_of(laws, 0.5, 0.0) == Approx(40.0 + 8.0 + 500.0).epsilon(kRounding));
  CHECK(force_of(laws, -0.3, 0.0) == Approx(-20.0 + 2.0 - 300.0).epsilon(kRounding));
}

TEST_CASE("A damper's law is one coefficient, one for each direction, or a table") {
  CHECK(force_of("damper = { coefficient = 8.0 }", 0.1, -0.5) == Approx(-4.0).epsilon(kRounding));
  const std::string two_way = "damper = { compression = 7.0, rebound = 11.0 }";
  CHECK(force_of(two_way, 0.1, 0.5) == Approx(3.5).epsilon(kRounding));
  CHECK(force_of(two_way, 0.1, -3.0) == Approx(-33.0).epsilon(kRounding));
  const std::string table = "damper = { table = [[-1.0, -40.0], [0.0, 0.0], [0.5, 10.0], [1.0, 12.0]] }";
  CHECK(force_of(table, 0.1, -0.25) == Approx(-10.0).epsilon(kRounding));
  CHECK(force_of(table, 0.1, 0.75) == Approx(11.0).epsilon(kRounding));
}

TEST_CASE("A tyre's law holds from touching on; one that is not one-sided pulls as well") {
  const std::string laws =
      "multiplicity = 2\nspring = { polynomial = [0.0, 1000.0, 600.0] }\ndamping = 40.0\n";
  CHECK(tyre_force_of(laws, 0.1, 0.3) == Approx(2.0 * (100.0 + 6.0 + 12.0)).epsilon(kRounding));
  CHECK(tyre_force_of(laws, -0.1, 0.3) == 0.0);
  CHECK(tyre_force_of(laws, 0.1, -3.0) == 0.0);
  const std::string linear = "spring = { polynomial = [0.0, 1000.0] }\none_sided = false\n";
  CHECK(tyre_force_of(linear, -0.1, 0.3) == Approx(-100.0).epsilon(kRounding));
}

TEST_CASE("A spring of negative stiffness is refused") {
  CHECK(error_of(spring_damper("spring = { polynomial = [0.0, -5.0] }")) ==
        "f.toml:7:25: error: 'forces.s.spring.polynomial' has a negative stiffness at deflection 0: "
        "coefficient 1 is -5, must be ≥ 0");
  CHECK(error_of(spring_damper("spring = { polynomial = [3.0, 0.0, -5.0] }")) ==
        "f.toml:7:25: error: 'forces.s.spring.polynomial' has a negative stiffness at deflection 0: "
        "coefficient 2 is -5, must be ≥ 0");
  CHECK(error_of(spring_damper("spring = { table = [[-1.0, 0.0], [0.0, 4.0], [1.0, 3.0]] }")) ==
        "f.toml:7:20: error: 'forces.s.spring.table' has a negative stiffness at deflection 0: -1 N/m, must "
        "be ≥ 0");
  CHECK(error_of(spring_damper(
            "spring = { polynomial = [0.0, 5.0] }\ncompression_stop = { deflection = 0.1, rate = -1.0 }")) ==
        "f.toml:8:47: error: 'forces.s.compression_stop.rate' must be > 0 N/m, got -1");
  CHECK(error_of(tyre("spring = { polynomial = [0.0, 0.0, -5.649e7] }")) ==
        "f.toml:6:25: error: 'forces.t.spring.polynomial' has a negative stiffness at deflection 0: "
        "coefficient 2 is -56490000, must be ≥ 0");
}

TEST_CASE("A damper that generates energy is refused") {
  CHECK(error_of(spring_damper("damper = { coefficient = -1.0 }")) ==
        "f.toml:7:26: error: 'forces.s.damper.coefficient' must be ≥ 0 N·s/m, got -1");
  CHECK(error_of(spring_damper("damper = { compression = 1.0, rebound = -1.0 }")) ==
        "f.toml:7:41: error: 'forces.s.damper.rebound' must be ≥ 0 N·s/m, got -1");
  CHECK(error_of(spring_damper("damper = { table = [[-1.0, 2.0], [0.0, 0.0], [1.0, 2.0]] }")) ==
        "f.toml:7:21: error: 'forces.s.damper.table.0' puts energy in: 2 N at -1 m/s, the signs must agree");
  CHECK(error_of(spring_damper("damper = { table = [[-1.0, -2.0], [1.0, 3.0]] }")) ==
        "f.toml:7:20: error: 'forces.s.damper.table' must give no force at rest: 0.5 N at 0 m/s; add the "
        "point [0, 0]");
  CHECK(error_of(spring_damper("damper = { table = [[-1.0, -2.0], [0.0, 0.0], [1.0, 3.0], [2.0, 1.0]] }")) ==
        "f.toml:7:20: error: 'forces.s.damper.table' must not fall at its ends, which go on straight: the "
        "damper would put energy in");
  CHECK(error_of(tyre("spring = { polynomial = [0.0, 5.0] }\ndamping = -1.0")) ==
        "f.toml:7:11: error: 'forces.t.damping' must be ≥ 0 N·s/m, got -1");
}

TEST_CASE("A law is given in one way, and completely") {
  CHECK(error_of(spring_damper("")) ==
        "f.toml:1:1: error: 'forces.s' must have a 'spring', a stop or a 'damper'");
  CHECK(error_of(spring_damper("spring = {}")) ==
        "f.toml:7:10: error: 'forces.s.spring' must have either 'polynomial' or 'table'");
  CHECK(error_of(spring_damper("spring = { polynomial = [] }")) ==
        "f.toml:7:25: error: 'forces.s.spring.polynomial' must have at least one coefficient [N/m^k]");
  CHECK(error_of(spring_damper("spring = { polynomal = [1.0] }")) ==
        "f.toml:7:12: error: unknown key 'polynomal' in 'forces.s.spring' (did you mean 'polynomial'?)");
  CHECK(
      error_of(spring_damper("spring = { polynomial = [0.0, 1.0], table = [[0.0, 0.0], [1.0, 1.0]] }")) ==
      "f.toml:7:10: error: 'forces.s.spring' must have either 'polynomial' or 'table', not several of them");
  CHECK(error_of(spring_damper("damper = { compression = 3.0 }")) ==
        "f.toml:7:10: error: missing key 'rebound' in 'forces.s.damper'");
  CHECK(error_of(spring_damper("damper = { rebound = 3.0 }")) ==
        "f.toml:7:10: error: missing key 'compression' in 'forces.s.damper'");
  CHECK(error_of(spring_damper("damper = { coefficient = 2.0, rebound = 3.0 }")) ==
        "f.toml:7:10: error: 'forces.s.damper' must have either 'coefficient', or 'compression' and "
        "'rebound', or 'table', not several of them");
  CHECK(error_of(spring_damper("damper = {}")) ==
        "f.toml:7:10: error: 'forces.s.damper' must have either 'coefficient', or 'compression' and "
        "'rebound', or 'table'");
  CHECK(error_of(tyre("damping = 3.0")) == "f.toml:1:1: error: missing key 'spring' in 'forces.t'");
}

TEST_CASE("A table's points are pairs that ascend") {
  CHECK(error_of(spring_damper("spring = { table = [[0.0, 0.0]] }")) ==
        "f.toml:7:20: error: 'forces.s.spring.table' must be at least 2 pairs [m, N], got 1");
  CHECK(error_of(spring_damper("spring = { table = [[0.0, 0.0], [1.0]] }")) ==
        "f.toml:7:33: error: 'forces.s.spring.table.1' must be a pair [m, N]");
  CHECK(error_of(spring_damper("spring = { table = [[0.0, 0.0], [0.0, 1.0]] }")) ==
        "f.toml:7:33: error: 'forces.s.spring.table.1' must ascend: 0 m comes after 0 m");
  CHECK(error_of(spring_damper("spring = { table = [[0.0, 0.0], [1.0, nan]] }")) ==
        "f.toml:7:39: error: 'forces.s.spring.table.1.1' must be a finite number [N], got nan");
}

TEST_CASE("A rebound stop lies below the compression stop") {
  CHECK(error_of(spring_damper("spring = { polynomial = [0.0, 5.0] }\n"
                               "compression_stop = { deflection = 0.1, rate = 9.0 }\n"
                               "rebound_stop = { deflection = 0.1, rate = 9.0 }")) ==
        "f.toml:9:31: error: 'forces.s.rebound_stop.deflection' must lie below the compression stop's 0.1 m, "
        "got 0.1 m");
}

TEST_CASE("A tyre has no force at penetration 0, and pushes at a penetration of its radius") {
  CHECK(error_of(tyre("spring = { polynomial = [3.0, 5.0] }")) ==
        "f.toml:6:10: error: 'forces.t.spring' of a tyre must give no force at penetration 0, got 3 N");
  CHECK(error_of(tyre("spring = { polynomial = [0.0, 0.0] }")) ==
        "f.toml:6:10: error: 'forces.t.spring' of a tyre must push at a penetration of its radius 0.5 m, got "
        "0 N");
  CHECK(error_of(tyre("spring = { polynomial = [0.0, 0.0, 5.0] }\none_sided = false")) ==
        "f.toml:6:10: error: 'forces.t.spring' of a tyre that is not one-sided must pull at a penetration of "
        "-0.5 m, got 1.25 N; use odd powers");
}

TEST_CASE("A rotational spring-damper's laws are over angles") {
  const std::string head =
      "name = \"r\"\ntype = \"rotational-spring-damper\"\na = \"p.origin\"\nb = \"q.origin\"\n";
  const std::unique_ptr<dynamics::ForceElement> force = dynamics::make_force(
      read(head + "free_angle = 0.2\nspring = { polynomial = [0.0, 50.0] }\ndamper = { coefficient = 3.0 }"),
      std::array{0, 1}, {});
  std::array<dynamics::MarkerState, 2> markers;
  markers[1].angle = 0.3;
  markers[1].omega = -2.0;
  std::array<int, 2> branches{};
  std::array<double, 4> channels{};
  force->calc_channels({.markers = markers}, branches, channels);
  CHECK(channels[3] == Approx(50.0 * -0.1 + 3.0 * 2.0).epsilon(kRounding));
  CHECK(error_of(head + "spring = { table = [[0.0, 0.0]] }") ==
        "f.toml:6:20: error: 'forces.r.spring.table' must be at least 2 pairs [rad, N·m], got 1");
  CHECK(error_of(head) == "f.toml:1:1: error: 'forces.r' must have a 'spring', a stop or a 'damper'");
}

TEST_CASE("An applied force has components in time, in the world's axes or following") {
  const std::string head = "name = \"a\"\ntype = \"applied\"\npoint = \"p.origin\"\n";
  const std::unique_ptr<dynamics::ForceElement> force = dynamics::make_force(
      read(head + "axes = \"following\"\nforce = [2.0, { polynomial = [0.0, 3.0] }]\ntorque = 5.0"),
      std::array{0}, {});
  std::array<dynamics::MarkerState, 1> markers;
  markers[0].angle = 0.7;
  std::array<double, 3> channels{};
  force->calc_channels({.time = 0.5, .markers = markers}, {}, channels);
  CHECK(channels[0] == Approx(2.0 * std::cos(0.7) - 1.5 * std::sin(0.7)).epsilon(kRounding));
  CHECK(channels[2] == 5.0);
  CHECK(error_of(head) == "f.toml:1:1: error: 'forces.a' must have a 'force' or a 'torque'");
  CHECK(error_of(head + "force = 3.0") ==
        "f.toml:5:9: error: 'forces.a.force' must be [x, y], each a number [N] or a function of time");
  CHECK(error_of(head + "torque = { step = { before = 0.0 } }") ==
        "f.toml:5:19: error: missing key 'after' in 'forces.a.torque.step'");
}

TEST_CASE("A tyre of distributed contact cannot pull") {
  CHECK(
      error_of(tyre("contact = \"distributed\"\nspring = { polynomial = [0.0, 5.0] }\none_sided = false")) ==
      "f.toml:8:13: error: 'forces.t.one_sided' must be true of a tyre with distributed contact, which "
      "cannot pull");
}
