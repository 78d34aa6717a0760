// The keys of force elements of suspensions.
#include "dynamics/element_input/suspension_input.h"

#include <array>
#include <cmath>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

dynamics::ForceDescription read(const std::string& text) {
  const support::TomlDocument document = support::TomlDocument::parse("[[forces]]\n" + text, "f.toml");
  dynamics::HistoryFiles histories("");
  return dynamics::read_force(document.root().at("forces").items().front().table(), histories);
}

std::string error_of(const std::string& text) {
  return input_error_of([&] { read(text); });
}

std::string stop(const std::string& laws) {
  return "name = \"h\"\ntype = \"hydraulic-stop\"\na = \"p.origin\"\nb = \"q.origin\"\n" + laws;
}

std::string bushing(const std::string& laws) {
  return "name = \"b\"\ntype = \"bushing\"\na = \"p.origin\"\nb = \"q.origin\"\n" + laws;
}

}  // namespace

TEST_CASE("A hydraulic stop has a contact length, and a spring, a metering or a damping") {
  const std::unique_ptr<dynamics::ForceElement> force = dynamics::make_force(
      read(stop("contact_length = 0.3\nspring = { polynomial = [0.0, 50.0] }\ndamping = 20.0\n"
                "metering = { table = [[0.0, 10.0], [0.2, 30.0]] }")),
      std::array{0, 1}, {});
  std::array<dynamics::MarkerState, 2> markers;
  markers[1].r = {0.0, 0.2};
  markers[1].v = {0.0, -2.0};
  std::array<int, 4> branches{};
  force->choose_branches({.markers = markers}, branches);
  std::array<double, 4> channels{};
  force->calc_channels({.markers = markers}, branches, channels);
  // Overlap 0.1 m at 2 m/s: spring, damping, and the metering half-way between its points.
  CHECK(channels[3] == Approx(50.0 * 0.1 + 20.0 * 0.1 * 2.0 + 20.0 * 4.0).epsilon(1e-13));
  CHECK(error_of(stop("damping = 50.0")) == "f.toml:1:1: error: missing key 'contact_length' in 'forces.h'");
  CHECK(error_of(stop("contact_length = 0.0\ndamping = 50.0")) ==
        "f.toml:6:18: error: 'forces.h.contact_length' must be > 0 m, got 0");
  CHECK(error_of(stop("contact_length = 0.3")) ==
        "f.toml:1:1: error: 'forces.h' must have a 'spring', a 'metering' or a 'damping'");
  CHECK(error_of(stop("contact_length = 0.3\ndamping = -1.0")) ==
        "f.toml:7:11: error: 'forces.h.damping' must be ≥ 0 N·s/m², got -1");
  CHECK(error_of(stop("contact_length = 0.3\nmetering = { coefficient = -1.0 }")) ==
        "f.toml:7:28: error: 'forces.h.metering.coefficient' must be ≥ 0 N·s²/m², got -1");
  CHECK(error_of(stop("contact_length = 0.3\nmetering = { table = [[0.1, 1.0], [0.2, 1.0]] }")) ==
        "f.toml:7:22: error: 'forces.h.metering.table' must begin at overlap 0, begins at 0.1 m");
  CHECK(error_of(stop("contact_length = 0.3\nmetering = { table = [[0.0, 2.0], [0.2, 1.0]] }")) ==
        "f.toml:7:22: error: 'forces.h.metering.table' must not fall at its end, which goes on straight: the "
        "resistance would become negative");
  CHECK(error_of(stop("contact_length = 0.3\ndamping = 50.0\ndampng = 1.0")) ==
        "f.toml:8:1: error: unknown key 'dampng' in 'forces.h' (did you mean 'damping'?)");
}

TEST_CASE("A bushing has laws in at least one direction") {
  const std::unique_ptr<dynamics::ForceElement> force = dynamics::make_force(
      read(bushing(
          "free_position = [0.1, 0.0]\nfree_angle = 0.5\nmultiplicity = 2\n"
          "x = { spring = { polynomial = [0.0, 50.0] } }\nrotation = { damper = { coefficient = 3.0 } }")),
      std::array{0, 1}, {});
  std::array<dynamics::MarkerState, 2> markers;
  markers[1].r = {0.3, 0.2};
  markers[1].omega = -2.0;
  std::array<int, 6> branches{};
  std::array<double, 9> channels{};
  force->calc_channels({.markers = markers}, branches, channels);
  CHECK(channels[6] == Approx(-2.0 * 50.0 * 0.2).epsilon(1e-13));
  CHECK(channels[7] == 0.0);
  CHECK(channels[2] == -0.5);
  CHECK(channels[8] == Approx(2.0 * 3.0 * 2.0).epsilon(1e-13));
  CHECK(error_of(bushing("angle = 0.1")) ==
        "f.toml:1:1: error: 'forces.b' must have laws for at least one of 'x', 'y' and 'rotation'");
  CHECK(error_of(bushing("y = {}")) ==
        "f.toml:6:5: error: 'forces.b.y' must have a 'spring', a 'damper' or a 'relaxation'");
  CHECK(error_of(bushing("y = { spring = { polynomial = [0.0, -5.0] } }")) ==
        "f.toml:6:31: error: 'forces.b.y.spring.polynomial' has a negative stiffness at deflection 0: "
        "coefficient 1 is -5, must be ≥ 0");
  CHECK(error_of(bushing("y = { relaxation = { stiffness = 5.0 } }")) ==
        "f.toml:6:20: error: missing key 'time' in 'forces.b.y.relaxation'");
  CHECK(error_of(bushing("rotation = { relaxation = { stiffness = 5.0, time = 0.0 } }")) ==
        "f.toml:6:53: error: 'forces.b.rotation.relaxation.time' must be > 0 s, got 0");
  CHECK(error_of(bushing("x = { damper = { coefficient = 1.0 } }\nmultiplicity = 0")) ==
        "f.toml:7:16: error: 'forces.b.multiplicity' must be > 0 and ≤ 1000000, got 0");
}

TEST_CASE(
    "A leaf spring has a spring, and friction that is positive and does not change faster than it builds "
    "up") {
  const std::string head =
      "name = \"l\"\ntype = \"leaf-spring\"\na = \"p.origin\"\nb = \"q.origin\"\nfree_length = 1.0\n"
      "spring = { polynomial = [0.0, 50.0] }\npresliding_deflection = 0.01\n";
  const std::unique_ptr<dynamics::ForceElement> force = dynamics::make_force(
      read(head + "friction = { table = [[0.0, 4.0], [0.1, 6.0]] }"), std::array{0, 1}, {});
  std::array<dynamics::MarkerState, 2> markers;
  markers[1].r = {0.0, 0.95};
  // Full friction where ½z² is ½ β F, F being the largest.
  const std::array<double, 1> states{std::sqrt(6.0 * 0.01)};
  std::array<double, 5> channels{};
  force->calc_channels({.markers = markers, .states = states}, {}, channels);
  CHECK(channels[3] == Approx(50.0 * 0.05 + 5.0).epsilon(1e-13));
  CHECK(error_of(head) == "f.toml:1:1: error: missing key 'friction' in 'forces.l'");
  CHECK(error_of(head + "friction = { coefficient = 0.0 }") ==
        "f.toml:9:28: error: 'forces.l.friction.coefficient' must be > 0 N, got 0");
  CHECK(error_of(head + "friction = { table = [[0.0, 4.0], [0.1, -6.0]] }") ==
        "f.toml:9:41: error: 'forces.l.friction.table.1.1' must be > 0 N, got -6");
  CHECK(error_of(head + "friction = { table = [[0.0, 1.0], [0.01, 4.0]] }") ==
        "f.toml:9:35: error: 'forces.l.friction.table.1' changes by 300 N/m from the point before; friction "
        "that builds up over 0.01 m can change by at most 200 N/m there, or it would put energy in");
}
