#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/support/toml/toml.h"
#include "tools/support/toml/toml_text.h"

namespace sprung::support {

namespace {

// " [kg]", or nothing for a pure number.
std::string bracketed(std::string_view unit) {
  return unit.empty() ? "" : fmt::format(" [{}]", unit);
}

// "> 0 kg", "≥ 0 and ≤ 1".
std::string format_range(const Quantity& quantity) {
  std::string text;
  const auto add = [&text](std::string_view relation, const std::optional<double>& bound) {
    if (!bound) return;
    if (!text.empty()) text += " and ";
    text += fmt::format("{} {}", relation, format_number(*bound));
  };
  add(">", quantity.above);
  add("≥", quantity.at_least);
  add("≤", quantity.at_most);
  if (!quantity.unit.empty()) text += fmt::format(" {}", quantity.unit);
  return text;
}

bool is_in_range(const Quantity& quantity, double value) {
  return (!quantity.above || value > *quantity.above) &&
         (!quantity.at_least || value >= *quantity.at_least) &&
         (!quantity.at_most || value <= *quantity.at_most);
}

// The largest magnitude of a value. Within it products of several values and their squares stay finite, and
// rounding of times and places is below a micrometre or a microsecond.
double find_limit(std::string_view unit) {
  constexpr double kMost = 1e30, kMostOfTimesAndPlaces = 1e9;
  constexpr std::array<std::string_view, 6> kTimesAndPlaces{"m", "rad", "s", "Hz", "m/s", "rad/s"};
  const bool is_short =
      std::find(kTimesAndPlaces.begin(), kTimesAndPlaces.end(), unit) != kTimesAndPlaces.end();
  return is_short ? kMostOfTimesAndPlaces : kMost;
}

// The smallest value of a quantity that must be positive: its inverse and the square of that stay finite.
constexpr double kLeastPositive = 1e-50;

std::string format_integer_range(std::int64_t minimum, std::int64_t maximum) {
  const bool bounded_below = minimum != std::numeric_limits<std::int64_t>::min();
  const bool bounded_above = maximum != std::numeric_limits<std::int64_t>::max();
  if (bounded_below && bounded_above) return fmt::format(" from {} to {}", minimum, maximum);
  if (bounded_below) return fmt::format(" ≥ {}", minimum);
  if (bounded_above) return fmt::format(" ≤ {}", maximum);
  return "";
}

}  // namespace

bool TomlValue::is_table() const {
  return std::holds_alternative<TomlNode::Table>(node_->value);
}
bool TomlValue::is_array() const {
  return std::holds_alternative<TomlNode::Array>(node_->value);
}
bool TomlValue::is_string() const {
  return std::holds_alternative<std::string>(node_->value);
}
bool TomlValue::is_integer() const {
  return std::holds_alternative<std::int64_t>(node_->value);
}
bool TomlValue::is_number() const {
  return is_integer() || std::holds_alternative<double>(node_->value);
}

bool TomlValue::boolean() const {
  if (const bool* value = std::get_if<bool>(&node_->value)) return *value;
  throw error(fmt::format("must be true or false, got {}", describe(*node_)));
}

double TomlValue::number(const Quantity& quantity) const {
  if (!is_number()) {
    throw error(fmt::format("must be a number{}, got {}", bracketed(quantity.unit), describe(*node_)));
  }
  const std::int64_t* integer = std::get_if<std::int64_t>(&node_->value);
  const double value = integer ? static_cast<double>(*integer) : std::get<double>(node_->value);
  if (!std::isfinite(value)) {
    throw error(
        fmt::format("must be a finite number{}, got {}", bracketed(quantity.unit), format_number(value)));
  }
  if (!is_in_range(quantity, value)) {
    throw error(fmt::format("must be {}, got {}", format_range(quantity), format_number(value)));
  }
  Quantity limits{.unit = quantity.unit};
  const double limit = find_limit(quantity.unit);
  if (std::abs(value) > limit) (value > 0.0 ? limits.at_most : limits.at_least) = std::copysign(limit, value);
  if (quantity.above == 0.0 && value < kLeastPositive) limits.at_least = kLeastPositive;
  if (!is_in_range(limits, value)) {
    throw error(fmt::format("must be {}, got {}", format_range(limits), format_number(value)));
  }
  return value;
}

std::int64_t TomlValue::integer(std::int64_t minimum, std::int64_t maximum) const {
  const std::int64_t* value = std::get_if<std::int64_t>(&node_->value);
  if (value != nullptr && *value >= minimum && *value <= maximum) return *value;
  throw error(fmt::format("must be an integer{}, got {}", format_integer_range(minimum, maximum),
                          value != nullptr ? fmt::format("{}", *value) : describe(*node_)));
}

const std::string& TomlValue::string() const {
  if (const std::string* value = std::get_if<std::string>(&node_->value)) return *value;
  throw error(fmt::format("must be a string, got {}", describe(*node_)));
}

std::vector<TomlValue> TomlValue::items() const {
  const TomlNode::Array* array = std::get_if<TomlNode::Array>(&node_->value);
  if (array == nullptr) throw error(fmt::format("must be an array, got {}", describe(*node_)));
  return {array->items.begin(), array->items.end()};
}

std::vector<double> TomlValue::numbers(const Quantity& quantity) const {
  if (!is_array()) {
    throw error(
        fmt::format("must be an array of numbers{}, got {}", bracketed(quantity.unit), describe(*node_)));
  }
  std::vector<double> values;
  for (const TomlValue& item : items()) values.push_back(item.number(quantity));
  return values;
}

std::vector<double> TomlValue::numbers(const Quantity& quantity, std::size_t count) const {
  const TomlNode::Array* array = std::get_if<TomlNode::Array>(&node_->value);
  if (array == nullptr || array->items.size() != count) {
    throw error(fmt::format("must be an array of {} numbers{}, got {}", count, bracketed(quantity.unit),
                            describe(*node_)));
  }
  return numbers(quantity);
}

TomlTable TomlValue::table() const {
  return TomlTable(*node_);
}

const std::string& TomlValue::one_of(std::span<const std::string> words) const {
  const std::string* value = std::get_if<std::string>(&node_->value);
  if (value != nullptr && std::find(words.begin(), words.end(), *value) != words.end()) return *value;
  std::string list;
  for (const std::string& word : words) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word);
  throw error(fmt::format("must be one of {}; got {}{}", list, describe(*node_),
                          value != nullptr ? nearest_name_hint(*value, words) : ""));
}

InputError TomlValue::error(std::string_view message) const {
  return InputError(node_->location, fmt::format("'{}' {}", node_->key, message));
}

}  // namespace sprung::support
