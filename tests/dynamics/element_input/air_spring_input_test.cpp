#include "dynamics/element_input/air_spring_input.h"

#include <array>
#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::AirSpring;

namespace {

const std::string kHead =
    "name = \"b\"\ntype = \"air-spring\"\na = \"p.origin\"\nb = \"q.origin\"\ndesign_height = 0.3\n"
    "effective_area = 0.05\nvolume = 0.014\n";
const std::string kValve =
    "levelling = { dead_band = 0.003, full_opening = 0.01, delay = 2.0, supply_gauge_pressure = 8e5, "
    "orifice = { diameter = 0.002 } }\n";

dynamics::ForceDescription read(const std::string& text) {
  const support::TomlDocument document = support::TomlDocument::parse("[[forces]]\n" + text, "f.toml");
  dynamics::HistoryFiles histories("");
  return dynamics::read_force(document.root().at("forces").items().front().table(), histories);
}

AirSpring::Parameters parameters_of(const std::string& text) {
  return std::get<AirSpring::Parameters>(read(text).parameters);
}

std::string error_of(const std::string& text) {
  return test::input_error_of([&] { read(text); });
}

}  // namespace

TEST_CASE(
    "The pressure of an air spring follows from the gauge pressure, or from the load at the design height") {
  CHECK(parameters_of(kHead + "gauge_pressure = 5e5").pressure == 601325.0);
  CHECK(parameters_of(kHead + "load = 25e3\nambient_pressure = 1e5").pressure == Approx(6e5).epsilon(1e-12));
  const dynamics::ForceDescription rest = read(kHead + "load = \"static\"");
  REQUIRE(rest.static_length);
  CHECK(rest.static_length->length == 0.3);
  CHECK(error_of(kHead) == "f.toml:1:1: error: 'forces.b' must have either 'gauge_pressure' or 'load'");
  CHECK(error_of(kHead + "gauge_pressure = -1.0") ==
        "f.toml:9:18: error: 'forces.b.gauge_pressure' must be > 0 Pa, got -1");
  CHECK(error_of(kHead + "load = 1e3\nexponent = 0.9") ==
        "f.toml:10:12: error: 'forces.b.exponent' must be ≥ 1 and ≤ 1.67, got 0.9");
}

TEST_CASE("The effective area of an air spring is a smooth curve through its table, and level beyond it") {
  const AirSpring::Parameters p = parameters_of(
      "name = \"b\"\ntype = \"air-spring\"\na = \"p.origin\"\nb = \"q.origin\"\ndesign_height = 0.3\n"
      "effective_area = [[0.2, 0.06], [0.4, 0.04]]\nvolume = 0.014\ngauge_pressure = 5e5");
  CHECK(p.effective_area.value(0.3) == Approx(0.05).epsilon(1e-12));
  CHECK(p.effective_area.slope(0.3) == Approx(-1.5 * 0.1).epsilon(1e-12));  // of a cubic, level at both ends
  CHECK(p.effective_area.value(0.1) == Approx(0.06).epsilon(1e-12));
  CHECK(p.effective_area.value(0.6) == Approx(0.04).epsilon(1e-12));
  CHECK(error_of(
            "name = \"b\"\ntype = \"air-spring\"\na = \"p.origin\"\nb = \"q.origin\"\ndesign_height = 0.3\n"
            "effective_area = [[0.1, 0.001], [0.2, 0.001], [0.3, 0.5]]\nvolume = 0.014\nload = 1e3") ==
        "f.toml:7:33: error: 'forces.b.effective_area.1' swings the smooth curve through the points to "
        "-0.0002665 "
        "m² at 0.106 m; add points");
}

TEST_CASE("An air spring has an auxiliary volume, a partner and a levelling valve where it is asked for") {
  const AirSpring::Parameters p =
      parameters_of(kHead +
                    "gauge_pressure = 5e5\nauxiliary = { volume = 0.02, orifice = { diameter = 0.01, "
                    "discharge_coefficient = 0.5 } }\n"
                    "partner = { a = \"p.x\", b = \"q.x\", line = { diameter = 0.02 } }");
  CHECK(p.auxiliary_volume == 0.02);
  CHECK(p.auxiliary_area == Approx(0.5 * 7.853981634e-5).epsilon(1e-9));
  CHECK(p.is_coupled);
  CHECK(p.line_area == Approx(0.7 * 3.141592654e-4).epsilon(1e-9));
  const AirSpring::Parameters levelled = parameters_of(kHead + "load = \"static\"\n" + kValve);
  REQUIRE(levelled.levelling);
  CHECK(levelled.levelling->supply_pressure == 901325.0);
  CHECK(
      error_of(kHead + "gauge_pressure = 5e5\n" + kValve) ==
      "f.toml:10:13: error: 'forces.b.levelling' needs load = \"static\": the valve holds the design height "
      "in "
      "equilibrium");
  CHECK(error_of(kHead +
                 "load = \"static\"\npartner = { a = \"p.x\", b = \"q.x\", line = { diameter = 0.02 } }") ==
        "f.toml:9:8: error: 'forces.b.load' must be a number of N where two air springs are coupled, got "
        "\"static\"");
  CHECK(error_of(kHead + "load = 1e3\nauxiliary = { volume = 0.02 }") ==
        "f.toml:10:13: error: missing key 'orifice' in 'forces.b.auxiliary'");
  CHECK(error_of(kHead + "load = 1e3\nauxiliary = { volume = 0.02, orifice = { diameter = 0.0 } }") ==
        "f.toml:10:53: error: 'forces.b.auxiliary.orifice.diameter' must be > 0 m, got 0");
}
