#include "fem/section_shapes.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/catch.h"
#include "tests/fem/frames.h"

namespace sprung::fem {

namespace {

constexpr double kRounding = 1e-14;  // relative

// Shear coefficient at ν = 0 from the energy of the shear flow q = Q S(s)/I in thin walls: κ = I² / (A ∫S²/t
// ds), for the I section with dimensions between the walls' middles, integrated by the trapezoidal rule.
double calc_energy_coefficient(double b, double h, double t_flange, double t_web) {
  const int steps = 20000;
  const double area = 2.0 * b * t_flange + h * t_web;
  const double second_moment = t_web * h * h * h / 12.0 + b * t_flange * h * h / 2.0;
  double integral = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double weight = (i == 0 || i == steps ? 0.5 : 1.0) / steps;
    const double s = 0.5 * b * i / steps;  // from the tip of a half flange; there are four
    const double in_flange = t_flange * s * 0.5 * h;
    integral += 4.0 * weight * 0.5 * b * in_flange * in_flange / t_flange;
    const double y = h * (static_cast<double>(i) / steps - 0.5);
    const double in_web = b * t_flange * 0.5 * h + t_web * (0.125 * h * h - 0.5 * y * y);
    integral += weight * h * in_web * in_web / t_web;
  }
  return second_moment * second_moment / (area * integral);
}

}  // namespace

TEST_CASE("A rectangle has the area, second moment and coefficient calculated by hand") {
  const SectionGeometry section = calc_section_geometry(Rectangle{.width = 0.03, .height = 0.2}, 0.3);
  CHECK(section.area == Approx(0.006).epsilon(kRounding));
  CHECK(section.second_moment == Approx(2e-5).epsilon(kRounding));             // 0.03 · 0.008 / 12
  CHECK(section.section_modulus == Approx(2e-4).epsilon(kRounding));           // 0.03 · 0.04 / 6
  CHECK(section.shear_coefficient == Approx(13.0 / 15.3).epsilon(kRounding));  // 10 · 1.3 / (12 + 3.3)
}

TEST_CASE("A rectangle without lateral contraction has the coefficient 5/6") {
  const SectionGeometry section = calc_section_geometry(Rectangle{.width = 0.07, .height = 0.02}, 0.0);
  CHECK(section.shear_coefficient == Approx(5.0 / 6.0).epsilon(kRounding));
}

TEST_CASE("A box is the outer rectangle without the inner one") {
  const SectionGeometry section = calc_section_geometry(Box{.width = 0.1, .height = 0.2, .wall = 0.01}, 0.3);
  CHECK(section.area == Approx(0.02 - 0.08 * 0.18).epsilon(kRounding));
  CHECK(section.second_moment == Approx((0.1 * 8e-3 - 0.08 * 5.832e-3) / 12.0).epsilon(kRounding));
  CHECK(section.section_modulus == Approx((0.1 * 8e-3 - 0.08 * 5.832e-3) / 1.2).epsilon(kRounding));
}

TEST_CASE("A square box has Cowper's coefficient of the thin-walled square tube") {
  // [Cowper 1966]: 20 (1 + ν) / (48 + 39 ν)
  const SectionGeometry section = calc_section_geometry(Box{.width = 0.1, .height = 0.1, .wall = 0.002}, 0.3);
  CHECK(section.shear_coefficient == Approx(26.0 / 59.7).epsilon(kRounding));
}

TEST_CASE("A flat box tends to the rectangle of its webs") {
  // m and n → 0: the flanges vanish beside the webs; first order in m = n = 1e-6
  const SectionGeometry section =
      calc_section_geometry(Box{.width = 1.5e-6, .height = 1.0, .wall = 0.5e-6}, 0.27);
  CHECK(section.shear_coefficient == Approx(12.7 / 14.97).epsilon(1e-5));
}

TEST_CASE("A tube is the outer circle without the inner one") {
  const SectionGeometry section = calc_section_geometry(Tube{.outer_diameter = 0.1, .wall = 0.01}, 0.3);
  CHECK(section.area == Approx(2.827433388230814e-3).epsilon(kRounding));            // π (0.05² − 0.04²)
  CHECK(section.second_moment == Approx(2.8981192229365856e-6).epsilon(kRounding));  // π/4 (0.05⁴ − 0.04⁴)
  // π/32 (0.1⁴ − 0.08⁴) / 0.1
  CHECK(section.section_modulus == Approx(5.796238445873171e-5).epsilon(kRounding));
  // m = 0.8: 7.8 · 1.64² / (8.8 · 1.64² + 23.6 · 0.64)
  CHECK(section.shear_coefficient == Approx(20.97888 / 38.77248).epsilon(kRounding));
}

TEST_CASE("A tube whose walls meet is the solid circle") {
  const SectionGeometry section = calc_section_geometry(Tube{.outer_diameter = 0.06, .wall = 0.03}, 0.3);
  CHECK(section.area == Approx(2.827433388230814e-3).epsilon(kRounding));  // π 0.03²
  CHECK(section.shear_coefficient == Approx(7.8 / 8.8).epsilon(kRounding));
}

TEST_CASE("An I section adds flanges and web") {
  const SectionGeometry section = calc_section_geometry(
      ISection{.height = 0.3, .flange_width = 0.15, .flange_thickness = 0.01, .web_thickness = 0.007}, 0.3);
  CHECK(section.area == Approx(0.003 + 0.28 * 0.007).epsilon(kRounding));
  // web 0.007 · 0.28³/12, flanges 2 (0.15 · 0.01³/12 + 0.0015 · 0.145²)
  const double second_moment = 0.007 * 0.021952 / 12.0 + 2.0 * (0.15e-6 / 12.0 + 0.0015 * 0.021025);
  CHECK(section.second_moment == Approx(second_moment).epsilon(kRounding));
  CHECK(section.section_modulus == Approx(second_moment / 0.15).epsilon(kRounding));
}

TEST_CASE("An I section has the coefficient calculated by hand") {
  // h = 0.2, m = 2 · 0.1 · 0.01 / (0.2 · 0.005) = 2, n = 0.5, ν = 0.3:
  // 13 · 49 / (12 + 144 + 600 + 720 + 0.3 · (11 + 132 + 540 + 720) + 30 · 0.25 · 6 + 1.5 · 0.25 · 52)
  const SectionGeometry section = calc_section_geometry(
      ISection{.height = 0.21, .flange_width = 0.1, .flange_thickness = 0.01, .web_thickness = 0.005}, 0.3);
  CHECK(section.shear_coefficient == Approx(637.0 / (1476.0 + 420.9 + 45.0 + 19.5)).epsilon(kRounding));
}

TEST_CASE(
    "The coefficient of an I section without lateral contraction follows from the energy of its shear flow") {
  const SectionGeometry section = calc_section_geometry(
      ISection{.height = 0.31, .flange_width = 0.17, .flange_thickness = 0.013, .web_thickness = 0.008}, 0.0);
  // the trapezoidal rule's error is below steps⁻² ≈ 3e-9
  CHECK(section.shear_coefficient ==
        Approx(calc_energy_coefficient(0.17, 0.297, 0.013, 0.008)).epsilon(1e-8));
}

TEST_CASE(
    "The coefficient of a box without lateral contraction is that of the I section of the same shear flow") {
  // Cut in two by its plane of symmetry, a box of width b is two walls of thickness t with flanges that carry
  // the flow of half the width: the same ∫S²/t as an I section of web 2t and flange width b.
  const SectionGeometry section =
      calc_section_geometry(Box{.width = 0.11, .height = 0.19, .wall = 0.004}, 0.0);
  CHECK(section.shear_coefficient ==
        Approx(calc_energy_coefficient(0.106, 0.186, 0.004, 0.008)).epsilon(1e-8));
}

TEST_CASE("Impossible dimensions are refused with name and value") {
  const auto message = [](const auto& section, double nu = 0.3) {
    return test::message_of<std::invalid_argument>([&] { calc_section_geometry(section, nu); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::check_contains(message(Rectangle{.width = -0.1, .height = 0.2}),
                       "width is -0.1 m, expected a finite value > 0");
  test::check_contains(message(Rectangle{.width = 0.1, .height = nan}), "height is nan m");
  test::check_contains(message(Box{.width = 0.1, .height = 0.3, .wall = 0.05}),
                       "wall is 0.05 m, expected less than half the width");
  test::check_contains(message(Box{.width = 0.3, .height = 0.1, .wall = 0.05}),
                       "wall is 0.05 m, expected less than half the height");
  test::check_contains(message(Box{.width = 0.3, .height = 0.1, .wall = 0.0}), "wall is 0 m");
  test::check_contains(message(Tube{.outer_diameter = 0.1, .wall = 0.051}),
                       "wall is 0.051 m, expected at most half the outer diameter");
  test::check_contains(message(Tube{.outer_diameter = 0.0, .wall = 0.051}), "outer_diameter is 0 m");
  test::check_contains(
      message(ISection{.height = 0.2, .flange_width = 0.1, .flange_thickness = 0.1, .web_thickness = 0.01}),
      "flange_thickness is 0.1 m, expected less than half the height");
  test::check_contains(
      message(ISection{.height = 0.2, .flange_width = 0.1, .flange_thickness = 0.01, .web_thickness = 0.1}),
      "web_thickness is 0.1 m, expected less than flange_width");
  test::check_contains(message(Rectangle{.width = 0.1, .height = 0.2}, 0.51),
                       "poissons_ratio is 0.51, expected -1 < value ≤ 0.5");
}

}  // namespace sprung::fem
