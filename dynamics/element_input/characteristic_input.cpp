#include "dynamics/element_input/characteristic_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

PiecewisePolynomial read_polynomial(const support::TomlValue& value, const LawUnits& units) {
  const std::vector<double> coefficients = value.numbers(support::any(units.coefficient));
  if (coefficients.empty())
    throw value.error(fmt::format("must have at least one coefficient [{}]", units.coefficient));
  // The first non-zero coefficient after the constant determines the stiffness for small d.
  const auto first =
      std::find_if(coefficients.begin() + 1, coefficients.end(), [](double a) { return a != 0.0; });
  if (first != coefficients.end() && *first < 0.0) {
    throw value.error(
        fmt::format("has a negative stiffness at deflection 0: coefficient {} is {}, must be ≥ 0",
                    first - coefficients.begin(), *first));
  }
  return PiecewisePolynomial(coefficients);
}

PiecewisePolynomial read_spring_table(const support::TomlValue& value, const LawUnits& units) {
  const PointList points = read_point_list(value, support::any(units.deflection), support::any(units.force));
  PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  // The slopes on either side of 0; the first and the last piece have no end.
  const double step = 1e-9 * (points.x.back() - points.x.front());
  const double softest = std::min(law.slope(-step), law.slope(step));
  if (!(softest >= 0.0)) {
    throw value.error(fmt::format("has a negative stiffness at deflection 0: {} {}, must be ≥ 0", softest,
                                  units.stiffness));
  }
  return law;
}

PiecewisePolynomial make_two_way_damper(double compression, double rebound) {
  if (compression == rebound) return PiecewisePolynomial({0.0, compression});
  return PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0},
                                             std::array{-rebound, 0.0, compression});
}

PiecewisePolynomial read_damper_table(const support::TomlValue& value, const LawUnits& units) {
  const PointList points = read_point_list(value, support::any(units.rate), support::any(units.force));
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!(points.x[i] * points.y[i] >= 0.0)) {
      throw value.items()[i].error(fmt::format("puts energy in: {} {} at {} {}, the signs must agree",
                                               points.y[i], units.force, points.x[i], units.rate));
    }
  }
  PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  const double largest = std::max(std::abs(*std::min_element(points.y.begin(), points.y.end())),
                                  std::abs(*std::max_element(points.y.begin(), points.y.end())));
  if (!(std::abs(law.value(0.0)) <= 1e-12 * largest)) {
    throw value.error(fmt::format("must give no force at rest: {} {} at 0 {}; add the point [0, 0]",
                                  law.value(0.0), units.force, units.rate));
  }
  if (!(law.slope(points.x.front()) >= 0.0) || !(law.slope(points.x.back()) >= 0.0)) {
    throw value.error("must not fall at its ends, which go on straight: the damper would put energy in");
  }
  return law;
}

}  // namespace

PiecewisePolynomial read_spring(const support::TomlTable& table, const LawUnits& units) {
  constexpr std::array<std::string_view, 2> kWays{"polynomial", "table"};
  const std::string_view way = find_only_key(table, kWays, "either 'polynomial' or 'table'");
  table.reject_unknown_keys();
  return way == "table" ? read_spring_table(table.at(way), units) : read_polynomial(table.at(way), units);
}

double read_stop(const support::TomlTable& table, bool rebound, PiecewisePolynomial& spring,
                 const LawUnits& units) {
  const double deflection = table.number("deflection", support::any(units.deflection));
  spring.continue_straight(deflection, table.number("rate", support::positive(units.stiffness)), rebound);
  table.reject_unknown_keys();
  return deflection;
}

PiecewisePolynomial read_damper(const support::TomlTable& table, const LawUnits& units) {
  // One key of a two-way damper stands for both here; the missing one is reported when it is read.
  const std::string_view two_way = table.has("compression") ? "compression" : "rebound";
  const std::array<std::string_view, 3> ways{"coefficient", two_way, "table"};
  const std::string_view way =
      find_only_key(table, ways, "either 'coefficient', or 'compression' and 'rebound', or 'table'");
  const support::Quantity coefficient = support::non_negative(units.damping);
  PiecewisePolynomial law;
  if (way == "coefficient") {
    law = PiecewisePolynomial({0.0, table.number(way, coefficient)});
  } else if (way == two_way) {
    law = make_two_way_damper(table.number("compression", coefficient), table.number("rebound", coefficient));
  } else {
    law = read_damper_table(table.at(way), units);
  }
  table.reject_unknown_keys();
  return law;
}

}  // namespace sprung::dynamics
