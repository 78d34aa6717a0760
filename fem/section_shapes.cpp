#include "fem/section_shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sprung::fem {

namespace {

void require(bool fits, const char* dimension, double value, const char* expected) {
  if (fits) return;
  throw std::invalid_argument(
      fmt::format("calc_section_geometry: {} is {} m, expected {}", dimension, value, expected));
}

void require_positive(const char* dimension, double value) {
  require(value > 0.0 && std::isfinite(value), dimension, value, "a finite value > 0");
}

void require_poissons_ratio(double value) {
  if (value > -1.0 && value <= 0.5) return;
  throw std::invalid_argument(
      fmt::format("calc_section_geometry: poissons_ratio is {}, expected -1 < value ≤ 0.5", value));
}

// The part that the thin-walled box and I section have in common (fem, eqs. 3, 4): m is the ratio of the
// flanges' area to the webs', flange the term of the shear in the flanges.
double calc_thin_walled_coefficient(double m, double nu, double flange) {
  const double numerator = 10.0 * (1.0 + nu) * (1.0 + 3.0 * m) * (1.0 + 3.0 * m);
  const double web = 12.0 + m * (72.0 + m * (150.0 + m * 90.0));
  const double web_nu = 11.0 + m * (66.0 + m * (135.0 + m * 90.0));
  return numerator / (web + nu * web_nu + flange);
}

}  // namespace

SectionGeometry calc_section_geometry(const Rectangle& rectangle, double poissons_ratio) {
  const auto& [width, height] = rectangle;
  const double nu = poissons_ratio;
  require_positive("width", width);
  require_positive("height", height);
  require_poissons_ratio(nu);
  const double second_moment = width * height * height * height / 12.0;
  return {.area = width * height,
          .second_moment = second_moment,
          .shear_coefficient = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu),
          .section_modulus = second_moment / (0.5 * height)};
}

SectionGeometry calc_section_geometry(const Box& box, double poissons_ratio) {
  const auto& [width, height, wall] = box;
  const double nu = poissons_ratio;
  require_positive("width", width);
  require_positive("height", height);
  require_positive("wall", wall);
  require(2.0 * wall < width, "wall", wall, "less than half the width");
  require(2.0 * wall < height, "wall", wall, "less than half the height");
  require_poissons_ratio(nu);

  const double inner_width = width - 2.0 * wall;
  const double inner_height = height - 2.0 * wall;
  const double n = (width - wall) / (height - wall);  // = m, the wall being uniform
  const double flange = 10.0 * n * n * n * (3.0 + nu + 3.0 * n);
  const double second_moment = (width * std::pow(height, 3) - inner_width * std::pow(inner_height, 3)) / 12.0;
  return {.area = 2.0 * wall * (width + height - 2.0 * wall),
          .second_moment = second_moment,
          .shear_coefficient = calc_thin_walled_coefficient(n, nu, flange),
          .section_modulus = second_moment / (0.5 * height)};
}

SectionGeometry calc_section_geometry(const Tube& tube, double poissons_ratio) {
  const auto& [diameter, wall] = tube;
  const double nu = poissons_ratio;
  require_positive("outer_diameter", diameter);
  require_positive("wall", wall);
  require(2.0 * wall <= diameter, "wall", wall, "at most half the outer diameter");
  require_poissons_ratio(nu);

  const double inner = diameter - 2.0 * wall;
  const double m_squared = (inner / diameter) * (inner / diameter);
  const double sum_squared = (1.0 + m_squared) * (1.0 + m_squared);
  const double second_moment = std::numbers::pi / 64.0 * (std::pow(diameter, 4) - std::pow(inner, 4));
  return {.area = std::numbers::pi * wall * (diameter - wall),
          .second_moment = second_moment,
          .shear_coefficient = 6.0 * (1.0 + nu) * sum_squared /
                               ((7.0 + 6.0 * nu) * sum_squared + (20.0 + 12.0 * nu) * m_squared),
          .section_modulus = second_moment / (0.5 * diameter)};
}

SectionGeometry calc_section_geometry(const ISection& section, double poissons_ratio) {
  const auto& [height, flange_width, flange_thickness, web_thickness] = section;
  const double nu = poissons_ratio;
  require_positive("height", height);
  require_positive("flange_width", flange_width);
  require_positive("flange_thickness", flange_thickness);
  require_positive("web_thickness", web_thickness);
  require(2.0 * flange_thickness < height, "flange_thickness", flange_thickness, "less than half the height");
  require(web_thickness < flange_width, "web_thickness", web_thickness, "less than flange_width");
  require_poissons_ratio(nu);

  const double web_height = height - 2.0 * flange_thickness;
  const double h = height - flange_thickness;  // between the flanges' middles
  const double m = 2.0 * flange_width * flange_thickness / (h * web_thickness);
  const double n = flange_width / h;
  const double flange = 30.0 * n * n * m * (1.0 + m) + 5.0 * nu * n * n * m * (8.0 + 9.0 * m);
  const double second_moment =
      (flange_width * std::pow(height, 3) - (flange_width - web_thickness) * std::pow(web_height, 3)) / 12.0;
  return {.area = 2.0 * flange_width * flange_thickness + web_height * web_thickness,
          .second_moment = second_moment,
          .shear_coefficient = calc_thin_walled_coefficient(m, nu, flange),
          .section_modulus = second_moment / (0.5 * height)};
}

}  // namespace sprung::fem
