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

/// Reads at least 2 pairs with ascending x.
/// @throws support::InputError at the pair that does not fit
PointList read_point_list(const support::TomlValue& value, const support::Quantity& x_unit,
                          const support::Quantity& y_unit);

/// The one key, of several ways of saying a thing, that a table uses; there must be exactly one.
/// @param expected  the ways in words, for messages: "either 'polynomial' or 'table'"
std::string_view find_only_key(const support::TomlTable& table, std::span<const std::string_view> keys,
                               std::string_view expected);

/// Two numbers [x, y] of one unit.
Eigen::Vector2d read_vector(const support::TomlValue& value, std::string_view unit);
/// A direction [x, y], not [0, 0], made of length 1.
Eigen::Vector2d read_direction(const support::TomlValue& value);

}  // namespace sprung::dynamics
