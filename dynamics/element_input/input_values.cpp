#include "dynamics/element_input/input_values.h"

#include <fmt/format.h>

namespace sprung::dynamics {

namespace {

// Whether a table may go on with a point at x.
bool continues_at(const std::vector<double>& points, double x, PointOrder order) {
  if (points.empty() || x > points.back()) return true;
  const bool is_third = points.size() > 1 && points[points.size() - 2] == x;
  return order == PointOrder::kWithJumps && x == points.back() && !is_third;
}

}  // namespace

PointList read_point_list(const support::TomlValue& value, const support::Quantity& x_unit,
                          const support::Quantity& y_unit, PointOrder order) {
  PointList points;
  for (const support::TomlValue& row : value.items()) {
    if (!row.is_array() || row.items().size() != 2) {
      throw row.error(fmt::format("must be a pair [{}, {}]", x_unit.unit, y_unit.unit));
    }
    const double x = row.items()[0].number(x_unit);
    if (!continues_at(points.x, x, order)) {
      const bool is_third = order == PointOrder::kWithJumps && x == points.x.back();
      throw row.error(fmt::format("must ascend{}: {} {} comes after {} {}",
                                  is_third ? ", and at a jump two are equal, not three" : "", x, x_unit.unit,
                                  points.x.back(), x_unit.unit));
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

std::string_view find_only_key(const support::TomlTable& table, std::span<const std::string_view> keys,
                               std::string_view expected) {
  std::string_view found;
  for (const std::string_view key : keys) {
    if (!table.has(key)) continue;
    if (!found.empty()) throw table.error(fmt::format("must have {}, not several of them", expected));
    found = key;
  }
  if (found.empty()) {
    table.reject_unknown_keys();
    throw table.error(fmt::format("must have {}", expected));
  }
  return found;
}

Eigen::Vector2d read_vector(const support::TomlValue& value, std::string_view unit) {
  const std::vector<double> numbers = value.numbers(support::any(unit), 2);
  return {numbers[0], numbers[1]};
}

Eigen::Vector2d read_direction(const support::TomlValue& value) {
  const Eigen::Vector2d direction = read_vector(value, "");
  if (!(direction.stableNorm() > 0.0)) throw value.error("must be a direction [x, y], got [0, 0]");
  return direction.stableNormalized();  // without overflow or underflow
}

}  // namespace sprung::dynamics
