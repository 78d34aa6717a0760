#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Points of a table [[x, y], …].
struct PointList {
  std::vector<double> x, y;
};

/// Whether two successive points of a table may have the same x, at which the function jumps.
enum class PointOrder { kAscending, kWithJumps };

/// Reads at least 2 pairs with ascending x.
/// @throws support::InputError at the first pair that is wrong
PointList read_point_list(const support::TomlValue& value, const support::Quantity& x_unit,
                          const support::Quantity& y_unit, PointOrder order = PointOrder::kAscending);

/// The one of several alternative keys that a table has; it must have exactly one.
/// @param expected  the alternatives in words, for messages: "either 'polynomial' or 'table'"
/// @throws support::InputError if the table has none of them, or several
std::string_view find_only_key(const support::TomlTable& table, std::span<const std::string_view> keys,
                               std::string_view expected);

/// How many equal elements act side by side.
inline constexpr support::Quantity kMultiplicity{.unit = "", .above = 0.0, .at_most = 1e6};

/// Two numbers [x, y] of one unit.
Eigen::Vector2d read_vector(const support::TomlValue& value, std::string_view unit);
/// A direction [x, y], not [0, 0], scaled to length 1.
Eigen::Vector2d read_direction(const support::TomlValue& value);

}  // namespace sprung::dynamics
