#include "dynamics/input/unit_remarks.h"

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;

namespace {

std::vector<std::string> remarks_on(const std::string& old_part, const std::string& new_part) {
  return dynamics::list_unit_remarks(
      dynamics::Run{}, test::read_cart(test::with_change(test::cart_text(), old_part, new_part)));
}

}  // namespace

TEST_CASE("A vehicle in SI units calls for no remark") {
  CHECK(remarks_on("mass = 4.0", "mass = 4.0").empty());
}

TEST_CASE("Lengths in millimetres and inertias in kg mm² are remarked on at their place") {
  CHECK(remarks_on("tip = [0.6, -0.1]", "tip = [600.0, -100.0]") ==
        std::vector<std::string>{
            "cart.toml:18:7: 'bodies.arm.points.tip' is 608.3 m away; lengths are in m, not in mm"});
  CHECK(remarks_on("inertia = 0.7", "inertia = 7e5") ==
        std::vector<std::string>{
            "cart.toml:15:11: 'bodies.arm.inertia' is that of 4 kg at a distance of 418.3 m; "
            "inertias are in kg·m², not in kg·mm²"});
  CHECK(remarks_on("free_length = 5.5", "free_length = 5500.0") ==
        std::vector<std::string>{
            "cart.toml:31:8: 'forces.rope.free_length' is 5500 m; lengths are in m, not in mm"});
}

TEST_CASE("Dimensions of suspension elements in other units are remarked on") {
  const auto with = [](const std::string& element) {
    return remarks_on("[[forces]]\nname = \"wheel\"",
                      "[[forces]]\nname = \"leg\"\na = \"arm.tip\"\nb = \"ground.peg\"\n" + element +
                          "\n[[forces]]\nname = \"wheel\"");
  };
  const auto about = [](const std::string& key, const std::string& rule) {
    return std::vector<std::string>{"cart.toml:43:8: 'forces.leg." + key + "; " + rule};
  };
  const auto air = [&](const std::string& height, const std::string& area, const std::string& volume) {
    return with("type = \"air-spring\"\ngauge_pressure = 4e5\ndesign_height = " + height +
                "\neffective_area = " + area + "\nvolume = " + volume);
  };
  CHECK(air("0.25", "0.05", "0.0125").empty());
  CHECK(air("250.0", "0.05", "0.0125") == about("design_height' is 250 m", "lengths are in m, not in mm"));
  CHECK(air("0.25", "500.0", "0.0125") ==
        about("effective_area' is 500 m²", "areas are in m², not in cm² or mm²"));
  CHECK(air("0.25", "0.05", "12.5") == about("volume' is 12.5 m³", "volumes are in m³, not in litres"));
  CHECK(with("type = \"leaf-spring\"\nfree_length = 410.0\nspring = { polynomial = [0.0, 1e5] }\n"
             "friction = { coefficient = 500.0 }\npresliding_deflection = 0.002") ==
        about("free_length' is 410 m", "lengths are in m, not in mm"));
  const auto leaf = [&](const std::string& rate, const std::string& presliding) {
    return with("type = \"leaf-spring\"\nfree_length = 0.41\nspring = { polynomial = [0.0, " + rate +
                "] }\nfriction = { coefficient = 500.0 }\npresliding_deflection = " + presliding);
  };
  CHECK(leaf("1e5", "0.002").empty());
  CHECK(leaf("1e5", "2.0") == about("presliding_deflection' is 2 m", "lengths are in m, not in mm"));
  // The arm's 4 kg weigh 36.06 N.
  CHECK(leaf("1.0", "0.002") ==
        about("spring' has 1 N/m, which the weight of the lighter body on it, 36.1 N, compresses by 36.1 m",
              "stiffnesses are in N/m, not in N/mm"));
  CHECK(with("type = \"bushing\"\nx = { spring = { polynomial = [0.0, 1.0] } }\n"
             "y = { spring = { polynomial = [0.0, 0.5] } }") ==
        about("spring' has 1 N/m, which the weight of the lighter body on it, 36.1 N, compresses by 36.1 m",
              "stiffnesses are in N/m, not in N/mm"));
  const auto orifice = [&](const std::string& diameter) {
    return with(
        "type = \"air-spring\"\ngauge_pressure = 4e5\ndesign_height = 0.25\neffective_area = 0.05\n"
        "volume = 0.0125\nauxiliary = { volume = 0.01, orifice = { diameter = " +
        diameter + ", discharge_coefficient = 1.0 } }");
  };
  CHECK(orifice("0.01").empty());
  CHECK(orifice("10.0") ==
        about("orifice' is 78.54 m², which is more than the effective_area", "lengths are in m, not in mm"));
  const std::string of_bushing = "type = \"bushing\"\nx = { spring = { polynomial = [0.0, 1e4] } }\nangle = ";
  CHECK(with(of_bushing + "0.7854").empty());
  CHECK(with(of_bushing + "45.0") == about("angle' is 45 rad", "angles are in rad, not in degrees"));
  CHECK(with("type = \"air-spring\"\ngauge_pressure = 4.0\ndesign_height = 0.25\neffective_area = 0.05\n"
             "volume = 0.0125") == about("gauge_pressure' is 4 Pa", "pressures are in Pa, not in bar"));
  CHECK(with("type = \"spring-damper\"\nfree_length = 0.3\ndamper = { coefficient = 0.05 }") ==
        about("damper' has 0.05 N·s/m, which slows the lighter body on it down in 80 s",
              "dampers are in N·s/m, not in N·s/mm"));
  CHECK(with("type = \"spring-damper\"\nfree_length = 0.3\ndamper = { coefficient = 0.5 }").empty());
  CHECK(with("type = \"hydraulic-stop\"\ncontact_length = 150.0\nspring = { polynomial = [0.0, 1e5] }\n"
             "metering = { coefficient = 1e4 }") ==
        about("contact_length' is 150 m", "lengths are in m, not in mm"));
}

TEST_CASE("Masses in tonnes are remarked on where inertia and points contradict them") {
  CHECK(remarks_on("mass = 4.0", "mass = 0.004") ==
        std::vector<std::string>{
            "cart.toml:14:8: 'bodies.arm.mass' is 0.004 kg, whose inertia is that at a distance of 13.23 m, "
            "where all points are within 0.6083 m; masses are in kg, not in t"});
  CHECK(remarks_on("mass = 4.0", "mass = 0.04").empty());  // 4.2 m, seven times as far as the points
}

TEST_CASE("Gravity in mm/s² and angles in degrees are remarked on, a centrifuge and a full turn are not") {
  // |(0, −9810)| / 9.80665 = 1000.3
  CHECK(remarks_on("gravity = [0.5, -9.0]", "gravity = [0.0, -9810.0]").front() ==
        "cart.toml:3:11: 'gravity' is 9810 m/s², 1000 times that of the Earth; it is in m/s², not in mm/s²");
  CHECK(remarks_on("position = [3.5, 0.9]", "position = [3.5, 0.9]\nangle = -30.0") ==
        std::vector<std::string>{
            "cart.toml:17:9: 'bodies.arm.angle' is -30 rad, more than a full turn; angles are "
            "in rad, not in degrees"});
  CHECK(remarks_on("position = [3.5, 0.9]", "position = [3.5, 0.9]\nangle = 6.28").empty());
  CHECK(remarks_on("gravity = [0.5, -9.0]", "gravity = [0.0, -25.0]").empty());  // Jupiter
  CHECK(remarks_on("gravity = [0.5, -9.0]", "gravity = [0.0, 9.8]").front() ==
        "cart.toml:3:11: 'gravity' points upwards, away from the road: its y is 9.8 m/s²");
  CHECK(remarks_on("gravity = [0.5, -9.0]", "gravity = [0.0, -900.0]").size() <= 1);  // 92 g
}

TEST_CASE("A speed that no road vehicle reaches is remarked on") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  dynamics::Run run;
  run.speed = -90.0;
  run.speed_location = {"run.toml", 2, 9};
  CHECK(dynamics::list_unit_remarks(run, cart) ==
        std::vector<std::string>{"run.toml:2:9: 'speed' is -90 m/s, or -324 km/h; speeds are in m/s"});
  run.speed = 30.0;
  CHECK(dynamics::list_unit_remarks(run, cart).empty());
}

TEST_CASE("Stiffnesses and dampers per millimetre are remarked on beside the weight of the lighter body") {
  // 4 kg weigh 4 |(0.5, −9)| = 36.06 N; three ropes of 1 N/m, and a wheel's body of 0.3 m radius.
  CHECK(remarks_on("spring = { polynomial = [10.0, 200.0, 30.0] }", "spring = { polynomial = [0.0, 1.0] }") ==
        std::vector<std::string>{"cart.toml:31:8: 'forces.rope.spring' has 1 N/m, which the weight of the "
                                 "lighter body on it, 36.1 N, "
                                 "compresses by 12 m; stiffnesses are in N/m, not in N/mm"});
  // Of 2 √(600 · 4) = 98 N·s/m three dampers of 0.011 N·s/m are 0.034 %.
  CHECK(remarks_on("damper = { compression = 7.0, rebound = 11.0 }",
                   "damper = { compression = 0.007, rebound = 0.011 }") ==
        std::vector<std::string>{"cart.toml:31:8: 'forces.rope.damper' has 0.011 N·s/m, 0.034 % of critical "
                                 "for the lighter body on it; "
                                 "dampers are in N·s/m, not in N·s/mm"});
  const std::vector<std::string> of_wheel =
      remarks_on("spring = { polynomial = [0.0, 1000.0, 600.0] }", "spring = { polynomial = [0.0, 1e-3] }");
  REQUIRE(of_wheel.size() == 1);
  CHECK_THAT(of_wheel.front(), Contains("'forces.wheel' carries at most 0.001 N, less than the weight of"));
}

TEST_CASE("A bump that is metres high is remarked on") {
  dynamics::Run run;
  run.road.height = 80.0;
  run.road.location = {"run.toml", 5, 1};
  CHECK(dynamics::list_unit_remarks(run, test::read_cart(test::cart_text())) ==
        std::vector<std::string>{"run.toml:5:1: 'road.height' is 80 m; heights are in m, not in mm"});
}

TEST_CASE("A random road that is rougher than all of ISO 8608 is remarked on") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  dynamics::Run run;
  run.road.location = {"run.toml", 5, 1};
  run.response.location = {"run.toml", 9, 1};
  run.road.random = {.spectrum = dynamics::RoadSpectrum::power_law(64.0, 2.0)};
  CHECK(dynamics::list_unit_remarks(run, cart) ==
        std::vector<std::string>{
            "run.toml:5:1: 'road' has a density of 64 m³ at 0.1 1/m, where class H of ISO 8608 "
            "has 0.26 m³; densities are in m³, not in 10⁻⁶ m³"});
  run.road.random = {.spectrum = dynamics::RoadSpectrum::power_law(0.5, 2.0), .rms = 26.4};
  run.response.road = dynamics::RoadSpectrum::power_law(2.0, 2.0);
  CHECK(dynamics::list_unit_remarks(run, cart) ==
        std::vector<std::string>{
            "run.toml:5:1: 'road.rms' is 26.4 m; heights are in m, not in mm",
            "run.toml:9:1: 'response.road' has a density of 2 m³ at 0.1 1/m, where class H of "
            "ISO 8608 has 0.26 m³; densities are in m³, not in 10⁻⁶ m³"});
  run.road.random->rms = 0.05;
  run.response.road = dynamics::RoadSpectrum::power_law(dynamics::calc_iso_density('H'), 2.0);
  CHECK(dynamics::list_unit_remarks(run, cart).empty());
}
