#include "dynamics/input/characteristic_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace sprung::dynamics {

namespace {

struct Points {
  std::vector<double> x, y;
};

Points read_points(const support::TomlValue& value, const support::Quantity& x_unit,
                   const support::Quantity& y_unit) {
  Points points;
  for (const support::TomlValue& row : value.items()) {
    if (!row.is_array() || row.items().size() != 2) {
      throw row.error(fmt::format("must be a pair [{}, {}]", x_unit.unit, y_unit.unit));
    }
    const double x = row.items()[0].number(x_unit);
    if (!points.x.empty() && !(x > points.x.back())) {
      throw row.error(
          fmt::format("must ascend: {} {} comes after {} {}", x, x_unit.unit, points.x.back(), x_unit.unit));
    }
    points.x.push_back(x);
    points.y.push_back(row.items()[1].number(y_unit));
  }
  if (points.x.size() < 2) {
    throw value.error(
        fmt::format("must be at least 2 pairs [{}, {}], got {}", x_unit.unit, y_unit.unit, points.x.size()));
  }
  return points;
}

PiecewisePolynomial read_polynomial(const support::TomlValue& value) {
  const std::vector<double> coefficients = value.numbers(support::any("N/m^k"));
  if (coefficients.empty()) throw value.error("must have at least one coefficient [N/m^k]");
  // The first coefficient that is not zero after the constant decides the stiffness where d is small.
  const auto first =
      std::find_if(coefficients.begin() + 1, coefficients.end(), [](double a) { return a != 0.0; });
  if (first != coefficients.end() && *first < 0.0) {
    throw value.error(
        fmt::format("has a negative stiffness at deflection 0: coefficient {} is {}, must be ≥ 0",
                    first - coefficients.begin(), *first));
  }
  return PiecewisePolynomial(coefficients);
}

PiecewisePolynomial read_spring_table(const support::TomlValue& value) {
  const Points points = read_points(value, support::any("m"), support::any("N"));
  const PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  // The piece on either side of 0; the first and the last go on for ever.
  const double step = 1e-9 * (points.x.back() - points.x.front());
  const double softest = std::min(law.slope(-step), law.slope(step));
  if (!(softest >= 0.0)) {
    throw value.error(fmt::format("has a negative stiffness at deflection 0: {} N/m, must be ≥ 0", softest));
  }
  return law;
}

// The one way of giving a law that the table uses; exactly one there must be.
std::string_view find_way(const support::TomlTable& table, std::span<const std::string_view> ways,
                          std::string_view expected) {
  std::string_view found;
  for (const std::string_view way : ways) {
    if (!table.has(way)) continue;
    if (!found.empty()) throw table.error(fmt::format("must have {}, not several of them", expected));
    found = way;
  }
  if (found.empty()) {
    table.reject_unknown_keys();
    throw table.error(fmt::format("must have {}", expected));
  }
  return found;
}

PiecewisePolynomial make_two_way_damper(double compression, double rebound) {
  if (compression == rebound) return PiecewisePolynomial({0.0, compression});
  return PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0},
                                             std::array{-rebound, 0.0, compression});
}

PiecewisePolynomial read_damper_table(const support::TomlValue& value) {
  const Points points = read_points(value, support::any("m/s"), support::any("N"));
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!(points.x[i] * points.y[i] >= 0.0)) {
      throw value.items()[i].error(
          fmt::format("puts energy in: {} N at {} m/s, the signs must agree", points.y[i], points.x[i]));
    }
  }
  PiecewisePolynomial law = PiecewisePolynomial::through_points(points.x, points.y);
  const double largest = std::max(std::abs(*std::min_element(points.y.begin(), points.y.end())),
                                  std::abs(*std::max_element(points.y.begin(), points.y.end())));
  if (!(std::abs(law.value(0.0)) <= 1e-12 * largest)) {
    throw value.error(
        fmt::format("must give no force at rest: {} N at 0 m/s; add the point [0, 0]", law.value(0.0)));
  }
  if (!(law.slope(points.x.front()) >= 0.0) || !(law.slope(points.x.back()) >= 0.0)) {
    throw value.error("must not fall at its ends, which go on straight: the damper would put energy in");
  }
  return law;
}

}  // namespace

PiecewisePolynomial read_spring(const support::TomlTable& table) {
  constexpr std::array<std::string_view, 2> kWays{"polynomial", "table"};
  const std::string_view way = find_way(table, kWays, "either 'polynomial' or 'table'");
  table.reject_unknown_keys();
  return way == "table" ? read_spring_table(table.at(way)) : read_polynomial(table.at(way));
}

double read_stop(const support::TomlTable& table, bool rebound, PiecewisePolynomial& spring) {
  const double deflection = table.number("deflection", support::any("m"));
  spring.continue_straight(deflection, table.number("rate", support::positive("N/m")), rebound);
  table.reject_unknown_keys();
  return deflection;
}

PiecewisePolynomial read_damper(const support::TomlTable& table) {
  // Either of the two-way damper's keys stands for both; the one that is missing is then missed.
  const std::string_view two_way = table.has("compression") ? "compression" : "rebound";
  const std::array<std::string_view, 3> ways{"coefficient", two_way, "table"};
  const std::string_view way =
      find_way(table, ways, "either 'coefficient', or 'compression' and 'rebound', or 'table'");
  const support::Quantity coefficient = support::non_negative("N·s/m");
  PiecewisePolynomial law;
  if (way == "coefficient") {
    law = PiecewisePolynomial({0.0, table.number(way, coefficient)});
  } else if (way == two_way) {
    law = make_two_way_damper(table.number("compression", coefficient), table.number("rebound", coefficient));
  } else {
    law = read_damper_table(table.at(way));
  }
  table.reject_unknown_keys();
  return law;
}

}  // namespace sprung::dynamics
