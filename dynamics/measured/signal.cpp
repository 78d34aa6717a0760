#include "dynamics/measured/signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace sprung::dynamics {

namespace {

struct NamedUnit {
  std::string_view name;
  KnownUnit unit;
};

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPoundForce = 4.4482216152605;  // N

constexpr std::array<NamedUnit, 32> kUnits{{
    {"m", {"m", 1.0}},       {"mm", {"m", 1e-3}},   {"cm", {"m", 1e-2}},     {"um", {"m", 1e-6}},
    {"µm", {"m", 1e-6}},     {"km", {"m", 1e3}},    {"in", {"m", 0.0254}},   {"ft", {"m", 0.3048}},
    {"s", {"s", 1.0}},       {"sec", {"s", 1.0}},   {"ms", {"s", 1e-3}},     {"min", {"s", 60.0}},
    {"N", {"N", 1.0}},       {"kN", {"N", 1e3}},    {"daN", {"N", 10.0}},    {"lbf", {"N", kPoundForce}},
    {"N·m", {"N·m", 1.0}},   {"Nm", {"N·m", 1.0}},  {"N*m", {"N·m", 1.0}},   {"N m", {"N·m", 1.0}},
    {"kN·m", {"N·m", 1e3}},  {"kNm", {"N·m", 1e3}}, {"kN*m", {"N·m", 1e3}},  {"N·mm", {"N·m", 1e-3}},
    {"Nmm", {"N·m", 1e-3}},  {"rad", {"rad", 1.0}}, {"mrad", {"rad", 1e-3}}, {"deg", {"rad", kDegree}},
    {"°", {"rad", kDegree}}, {"1", {"", 1.0}},      {"-", {"", 1.0}},        {"%", {"", 1e-2}},
}};

}  // namespace

std::optional<KnownUnit> find_unit(std::string_view name) {
  const auto found =
      std::find_if(kUnits.begin(), kUnits.end(), [&](const NamedUnit& one) { return one.name == name; });
  if (found == kUnits.end()) return std::nullopt;
  return found->unit;
}

std::string list_units(std::string_view si_unit) {
  std::string list;
  for (const NamedUnit& one : kUnits) {
    if (!si_unit.empty() && one.unit.si_unit != si_unit) continue;
    list += fmt::format("{}{}", list.empty() ? "" : ", ", one.name);
  }
  return list;
}

std::string list_names(std::span<const Signal> signals) {
  std::string list;
  for (const Signal& one : signals) list += fmt::format("{}'{}'", list.empty() ? "" : ", ", one.name);
  return list;
}

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace sprung::dynamics
