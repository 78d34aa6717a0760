#include "dynamics/input/time_function_input.h"

#include <fmt/format.h>

#include <array>

#include "dynamics/input/input_values.h"

namespace sprung::dynamics {

namespace {

TimeFunction read_harmonic(const support::TomlTable& table, std::string_view unit) {
  const TimeFunction f =
      TimeFunction::harmonic({.mean = table.number_or("mean", 0.0, support::any(unit)),
                              .amplitude = table.number("amplitude", support::any(unit)),
                              .frequency_hz = table.number("frequency", support::positive("Hz")),
                              .phase = table.number_or("phase", 0.0, support::any("rad"))});
  table.reject_unknown_keys();
  return f;
}

TimeFunction read_step(const support::TomlTable& table, std::string_view unit) {
  const TimeFunction::Step step{.before = table.number("before", support::any(unit)),
                                .after = table.number("after", support::any(unit)),
                                .start = table.number("start", support::any("s")),
                                .end = table.number("end", support::any("s"))};
  table.reject_unknown_keys();
  if (!(step.end > step.start)) {
    throw table.at("end").error(
        fmt::format("must come after the start of {} s, got {} s", step.start, step.end));
  }
  return TimeFunction::smooth_step(step);
}

}  // namespace

TimeFunction read_time_function(const support::TomlValue& value, std::string_view unit, TimeFunctionUse use) {
  if (value.is_number()) return TimeFunction(value.number(support::any(unit)));
  if (!value.is_table()) throw value.error(fmt::format("must be a number [{}] or a function of time", unit));
  const support::TomlTable table = value.table();
  constexpr std::array<std::string_view, 4> kWays{"polynomial", "harmonic", "table", "step"};
  const std::string_view way =
      find_only_key(table, kWays, "one of 'polynomial', 'harmonic', 'table' and 'step'");
  table.reject_unknown_keys();
  if (way == "harmonic") return read_harmonic(table.at(way).table(), unit);
  if (way == "step") return read_step(table.at(way).table(), unit);
  if (way == "table") {
    const PointList points = read_point_list(table.at(way), support::any("s"), support::any(unit));
    return use == TimeFunctionUse::kMotion ? TimeFunction::spline(points.x, points.y)
                                           : TimeFunction::lines(points.x, points.y);
  }
  const std::vector<double> coefficients = table.at(way).numbers(support::any(unit));
  if (coefficients.empty())
    throw table.at(way).error(fmt::format("must have at least one coefficient [{}/s^k]", unit));
  return TimeFunction::polynomial(coefficients);
}

}  // namespace sprung::dynamics
