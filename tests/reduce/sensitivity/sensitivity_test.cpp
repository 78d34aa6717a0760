#include "reduce/sensitivity/sensitivity.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "reduce/sensitivity/sensitivity_tables.h"
#include "reduce/sensitivity/sweep.h"
#include "tests/catch.h"
#include "tests/reduce/sensitivity/sensitivity_cases.h"
#include "tests/reduce/sensitivity/two_cantilevers.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/input_error.h"

namespace sprung::reduce {
namespace {

// All quantities one below the other.
Eigen::VectorXd stack(const BodyQuantities& q) {
  Eigen::VectorXd all(q.free_hz.size() + q.clamped_hz.size() + 2 + q.flexibility.size());
  all << q.free_hz, q.clamped_hz, q.mass, q.inertia, q.flexibility;
  return all;
}

Eigen::VectorXd calc_quantities(DesignSource source, const DesignParameter& parameter, double value) {
  source.overrides.push_back(fmt::format("{}={:.17g}", parameter.key, value));
  return stack(calc_sensitivity(read_design(source), {}, 5).value);
}

// Expected: the whole body made anew with the number changed, up and down, by two steps whose central
// differences are extrapolated.
TEST_CASE("derivatives by every number of a design are the differences of bodies made anew") {
  const DesignSource source = write_design("frame.toml", kFrame);
  const DesignSensitivity sensitivity = calc_all(source, 5);
  const Eigen::VectorXd value = stack(sensitivity.value);
  CHECK(sensitivity.parameters.size() == 6 + 3 + 4 + 4 + 8 + 2);
  for (const ParameterSensitivity& one : sensitivity.parameters) {
    const DesignParameter& parameter = one.parameter;
    const double scale = parameter.is_coordinate ? 1.0 : parameter.value;
    const auto difference = [&](double h) -> Eigen::VectorXd {
      return (calc_quantities(source, parameter, parameter.value + h * scale) -
              calc_quantities(source, parameter, parameter.value - h * scale)) /
             (2.0 * h);
    };
    const Eigen::VectorXd expected = (4.0 * difference(5e-4) - difference(1e-3)) / 3.0;
    const Eigen::VectorXd found = scale * stack(one.derivative);
    INFO(parameter.key);
    CHECK((found - expected).cwiseQuotient(value).cwiseAbs().maxCoeff() < 1e-8);
  }
}

// The closed form for a rigid pair: two stiff beams on a soft spring along them have ω² = k (1/m₁ + 1/m₂).
TEST_CASE("stiffnesses of springs are numbers of the frame") {
  std::string text = kBeam;
  text.replace(text.find("[[lines]]"), 9, "c = [4.5, 0.0]\nd = [7.5, 0.0]\n[[lines]]");
  text.replace(text.find("[reference]"), 11, R"([[lines]]
from = "c"
to = "d"
section = "beam"
elements = 9
[[springs]]
from = "b"
to = "c"
axial_stiffness = 100.0
rotational_stiffness = 1e8
[reference])");
  const DesignSensitivity sensitivity = calc_all(write_design("springs.toml", text), 1);
  const double k = 100.0, first = 157.0, second = 117.75;
  const double hz = std::sqrt(k * (1.0 / first + 1.0 / second)) / (2.0 * std::numbers::pi);
  CHECK(sensitivity.value.free_hz(0) == Approx(hz).epsilon(1e-5));
  const ParameterSensitivity& axial = find(sensitivity, "springs.0.axial_stiffness");
  CHECK(axial.parameter.unit == "N/m");
  CHECK(axial.derivative.free_hz(0) == Approx(0.5 * hz / k).epsilon(1e-5));
  CHECK(find(sensitivity, "springs.0.rotational_stiffness").parameter.unit == "N·m");
}

// Two equal cantilevers make pairs. Of a pair, the height of the first beam moves one frequency, in
// proportion, and leaves the other alone.
TEST_CASE("the members of an equal pair part as the closed form says") {
  const double height = 0.04;
  const DesignSensitivity sensitivity =
      calc_all(write_design("pair.toml", make_cantilevers(height, height)), 4);
  const Eigen::VectorXd hz = sensitivity.value.clamped_hz;
  REQUIRE(std::abs(hz(1) / hz(0) - 1.0) < 1e-9);
  for (const char* name : {"first", "second"}) {
    const BodyQuantities& by = find(sensitivity, fmt::format("sections.{}.height", name)).derivative;
    for (const Eigen::Index pair : {0, 2}) {
      CHECK(std::abs(by.clamped_hz(pair)) < 1e-6 * hz(pair) / height);
      CHECK(by.clamped_hz(pair + 1) == Approx(hz(pair) / height).epsilon(1e-8));
    }
  }
}

// f ∝ √(E/ρ) h/L² of a slender beam; its mass is ρ b h L.
TEST_CASE("a cantilever's frequencies follow modulus, density, width and length in closed form") {
  const DesignSensitivity sensitivity = calc_all(write_design("pair.toml", make_cantilevers(0.04, 0.04)), 4);
  const Eigen::VectorXd hz = sensitivity.value.clamped_hz;
  const auto rate = [&](const std::string& key) -> const BodyQuantities& {
    return find(sensitivity, key).derivative;
  };
  for (Eigen::Index i = 0; i < 4; ++i) {
    CHECK(rate("materials.steel.youngs_modulus").clamped_hz(i) == Approx(0.5 * hz(i) / 2.1e11).epsilon(1e-8));
    CHECK(rate("materials.steel.density").clamped_hz(i) == Approx(-0.5 * hz(i) / 7850.0).epsilon(1e-8));
    CHECK(std::abs(rate("sections.first.width").clamped_hz(i)) < 1e-6 * hz(i) / 0.05);
  }
  CHECK(rate("points.right.0").clamped_hz(0) == Approx(-2.0 * hz(0) / 2.0).epsilon(1e-8));
  CHECK(std::abs(rate("points.right.0").clamped_hz(1)) < 1e-6 * hz(0));
  CHECK(std::abs(rate("points.right.1").clamped_hz(0)) < 1e-6 * hz(0));
  CHECK(rate("points.right.0").mass == Approx(7850.0 * 0.05 * 0.04).epsilon(1e-9));
  CHECK(rate("sections.second.width").mass == Approx(7850.0 * 0.04 * 2.0).epsilon(1e-9));
}

// A mode's energies: strain over ω² and kinetic are 1 for the whole body, the point mass with the latter.
TEST_CASE("the shares of the elements add up to the mode's energy") {
  const DesignSensitivity sensitivity = calc_all(write_design("pair.toml", make_cantilevers(0.04, 0.04)), 4);
  CHECK((sensitivity.shares.strain.colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-8);
  CHECK((sensitivity.shares.kinetic.colwise().sum().array() - 1.0).abs().maxCoeff() < 1e-8);
}

TEST_CASE("tables speak of steps of 1 %, of 1 cm of a coordinate and of 1 of a zero") {
  const DesignSource source = write_design("pair.toml", make_cantilevers(0.04, 0.04));
  const Design design = read_design(source);
  const DesignSensitivity sensitivity = calc_sensitivity(design, list_parameters(source, design), 2);
  const std::string text = format_sensitivity(design, sensitivity);
  CHECK_THAT(text, Contains("sections.first.height") && Contains("1 %") && Contains("1 cm"));
  CHECK_THAT(text, Contains("flexibility, most"));
  CHECK(choose_step({.key = "", .value = 0.0, .unit = "kg", .rates = {}}) == 1.0);
  CHECK(choose_step({.key = "", .value = 2.0, .unit = "m", .rates = {}}) == 0.02);
  CHECK(choose_step({.key = "", .value = 2.0, .unit = "m", .is_coordinate = true, .rates = {}}) == 0.01);
  CHECK_THAT(format_sensitivity_json(design, sensitivity, {}), Contains("\"strain_energy_share\""));
}

// The tube is a solid bar: its wall cannot grow.
TEST_CASE("numbers at the end of their range, points on lines and fixed values are no parameters") {
  std::string text = kFrame;
  text.insert(text.find("[sections.arm]"),
              "[sections.bar]\nmaterial = \"steel\"\nshape = \"tube\"\nouter_diameter = 0.04\nwall = 0.02\n");
  text.replace(text.find("section = \"arm\""), 15, "section = \"bar\"");
  text.insert(text.find("right ="), "seat = [0.95, 0.05]\n");
  const DesignSource source = write_design("spare.toml", text);
  for (const DesignParameter& parameter : list_parameters(source, read_design(source))) {
    CHECK(parameter.key.find("seat") == std::string::npos);
    CHECK(parameter.key.find("bar") == std::string::npos);
    CHECK(parameter.key.find("arm") == std::string::npos);
    CHECK(parameter.key.find("count") == std::string::npos);
  }
}

// The second point at the right end stays where it is when the end moves, and then is a node of its own.
TEST_CASE("coordinates that another point ties are told, and the others are not") {
  std::string text = make_cantilevers(0.04, 0.04);
  text.insert(text.find("right ="), "copy = [2.0, 0.0]\n");
  const DesignSource source = write_design("tied.toml", text);
  std::vector<LeftOutNumber> left_out;
  list_parameters(source, read_design(source), &left_out);
  const std::string told = format_left_out(left_out);
  CHECK_THAT(told, Contains("points.right.0 is left out: ") && Contains("points.right.1 is left out: "));
  CHECK(told.find("left.") == std::string::npos);
  CHECK(format_left_out({}).empty());
  // The same in JSON: a list of keys with their reasons.
  const Design design = read_design(source);
  const std::string json =
      format_sensitivity_json(design, calc_sensitivity(design, list_parameters(source, design), 1), left_out);
  REQUIRE(left_out.size() == 4);  // of both points
  for (const LeftOutNumber& one : left_out) {
    CHECK_THAT(json, Contains("{\"key\":\"" + one.key + "\",\"reason\":\""));
  }
  CHECK_THAT(json, Contains("\"left_out\":["));
}

TEST_CASE("an override of a design is read in its place, and its faults are located") {
  DesignSource source = write_design("pair.toml", make_cantilevers(0.04, 0.04));
  source.overrides = {"sections.first.height=0.08", "sections.first.width=-1"};
  const std::string message = testing::message_of<support::InputError>([&] { read_design(source); });
  CHECK_THAT(message, Contains("--set 2") && Contains("sections.first.width"));
  source.overrides.pop_back();
  const Design design = read_design(source);
  const Design plain = read_design(source.path);
  CHECK(design.model.sections[0].bending_rigidity ==
        Approx(8.0 * plain.model.sections[0].bending_rigidity).epsilon(1e-12));
}

// Both heights and the right end are the parameter's: its derivative is the sum of theirs.
TEST_CASE("a parameter of a design stands for all numbers that name it") {
  const DesignSensitivity apart = calc_all(write_design("apart.toml", make_cantilevers(0.04, 0.04)), 5);
  std::string text = make_cantilevers(0.04, 0.04);
  for (std::size_t at = text.find("height = 0.04"); at != std::string::npos; at = text.find("height = 0.04"))
    text.replace(at, 13, "height = \"=high\"");
  text.replace(text.find("[2.0, 0.0]"), 10, "[\"=long\", 0.0]");
  text += "[parameters]\nhigh = 0.04\nlong = 2\n";
  const DesignSource source = write_design("named.toml", text);
  const DesignSensitivity named = calc_all(source, 5);
  CHECK((stack(named.value) - stack(apart.value)).cwiseQuotient(stack(apart.value)).norm() < 1e-12);
  const BodyQuantities& high = find(named, "parameters.high").derivative;
  const BodyQuantities& first = find(apart, "sections.first.height").derivative;
  const BodyQuantities& second = find(apart, "sections.second.height").derivative;
  CHECK(high.mass == Approx(first.mass + second.mass).epsilon(1e-9));
  for (Eigen::Index i = 0; i < 5; ++i) {  // free modes are single
    CHECK(high.free_hz(i) == Approx(first.free_hz(i) + second.free_hz(i)).epsilon(1e-7).margin(1e-6));
    CHECK(find(named, "parameters.long").derivative.free_hz(i) ==
          Approx(find(apart, "points.right.0").derivative.free_hz(i)).epsilon(1e-7));
  }
  const Design longer = read_design(DesignSource{source.path, {"parameters.long=3.5"}});
  CHECK(longer.model.mesh.node_positions.row(0).maxCoeff() == Approx(3.5));
}

TEST_CASE("a parameter that is not there is an error where it is named, and so is a wrong value of one") {
  std::string text = make_cantilevers(0.04, 0.04);
  text.replace(text.find("[2.0, 0.0]"), 10, "[\"=lang\", 0.0]");
  const auto message = [&](const std::string& parameters) {
    const DesignSource source = write_design("wrong.toml", text + parameters);
    return testing::message_of<support::InputError>([&] { read_design(source); });
  };
  CHECK_THAT(
      message("[parameters]\nlong = 2.0\n"),
      Contains("wrong.toml:8:10: error: ") &&
          Contains("names the parameter 'lang', which [parameters] does not have (did you mean 'long'?)"));
  CHECK_THAT(message("[parameters]\nlang = \"two\"\n"), Contains("parameters.lang"));
}

TEST_CASE("a parameter that nothing uses is an error where it is given, with the names of those there are") {
  std::string text = make_cantilevers(0.04, 0.04);
  text.replace(text.find("height = 0.04"), 13, "height = \"=high\"");
  const auto message = [](const DesignSource& source) {
    return testing::message_of<support::InputError>([&] { read_design(source); });
  };
  DesignSource source = write_design("used.toml", text + "[parameters]\nhigh = 0.04\n");
  source.overrides = {"parameters.high=0.05", "parameters.hih=0.05"};
  CHECK_THAT(message(source), Contains("--set 2: error: 'parameters.hih' is no parameter of the design; it "
                                       "has 'high' (did you mean 'high'?)"));
  source.overrides = {"sections.first.height=0.05"};  // takes the place of the only text that names 'high'
  CHECK(read_design(source).name == "used");
  const SweepOptions sweep{.design = source, .key = "parameters.hih", .values = {0.04, 0.05}, .num_modes = 2};
  CHECK_THAT(testing::message_of<support::InputError>([&] { calc_sweep(sweep); }),
             Contains("--vary: error: 'parameters.hih' is no parameter of the design"));
  CHECK_THAT(message(write_design("spare.toml", text + "[parameters]\nhigh = 0.04\nk = 3.0\n")),
             Contains("spare.toml:") && Contains("'parameters.k' is used by nothing"));
  source = write_design("none.toml", make_cantilevers(0.04, 0.04));
  source.overrides = {"parameters.high=0.05"};
  CHECK_THAT(message(source), Contains("--set 1: error: ") && Contains("which has no [parameters]"));
}

}  // namespace
}  // namespace sprung::reduce
