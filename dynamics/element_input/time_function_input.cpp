#include "dynamics/element_input/time_function_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

// Limits of what sums and products may grow to.
constexpr std::size_t kMostOscillations = 1000;
constexpr std::size_t kHighestDegree = 100;

// What is the same for all parts of a function of time.
struct FunctionContext {
  TimeFunctionUse use;
  HistoryFiles& histories;
  std::string_view unit;  // of the whole function
};

TimeFunction read_function(const support::TomlValue& value, std::string_view unit,
                           const FunctionContext& context);

TimeFunction read_harmonic(const support::TomlTable& table, std::string_view unit) {
  TimeFunction f = TimeFunction::harmonic({.mean = table.number_or("mean", 0.0, support::any(unit)),
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

// The integrators join times that lie closer, and would lose a pulse between them.
// @param times  ascending, or equal for a jump
void require_lengths(const support::TomlValue& value, std::span<const double> times) {
  constexpr double kShortest = 1e-9;  // s
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double length = times[i] - times[i - 1];
    if (length == 0.0 || length >= kShortest) continue;
    throw value.error(fmt::format(
        "changes at {:.15g} s and again {:.3g} s later, expected at least {:g} s; give a shorter pulse as "
        "a longer one of the same area",
        times[i - 1], length, kShortest));
  }
}

TimeFunction read_table(const support::TomlValue& value, std::string_view unit, TimeFunctionUse use) {
  if (use == TimeFunctionUse::kMotion) {
    const PointList points = read_point_list(value, support::any("s"), support::any(unit));
    require_lengths(value, points.x);
    return TimeFunction::spline(points.x, points.y);
  }
  const PointList points =
      read_point_list(value, support::any("s"), support::any(unit), PointOrder::kWithJumps);
  require_lengths(value, points.x);
  return TimeFunction::lines(points.x, points.y);
}

TimeFunction read_polynomial(const support::TomlValue& value, std::string_view unit) {
  const std::vector<double> coefficients = value.numbers(support::any(unit));
  if (coefficients.empty())
    throw value.error(fmt::format("must have at least one coefficient [{}/s^k]", unit));
  return TimeFunction::polynomial(coefficients);
}

std::vector<support::TomlValue> list_parts(const support::TomlValue& value) {
  std::vector<support::TomlValue> parts = value.items();
  if (parts.empty()) throw value.error("must have at least one function of time");
  return parts;
}

void check_size(const support::TomlValue& value, std::size_t oscillations) {
  if (oscillations <= kMostOscillations) return;
  throw value.error(fmt::format("has {} oscillations when it is multiplied out, must have at most {}",
                                oscillations, kMostOscillations));
}

// Of a product, before those of equal frequencies become polynomials.
std::size_t count_oscillations(const TimeFunction& a, const TimeFunction& b) {
  const std::size_t of_a = a.oscillations().size(), of_b = b.oscillations().size();
  return 2 * of_a * of_b + (b.polynomials().is_zero() ? 0 : of_a) + (a.polynomials().is_zero() ? 0 : of_b);
}

std::size_t find_degree(const PiecewisePolynomial& f) {
  std::size_t highest = 0;
  for (std::size_t k = 0; k < f.num_pieces(); ++k) highest = std::max(highest, f.coefficients(k).size() - 1);
  return highest;
}

std::size_t find_degree(const TimeFunction& f) {
  std::size_t highest = find_degree(f.polynomials());
  for (const TimeFunction::Oscillation& one : f.oscillations()) {
    highest = std::max(highest, find_degree(one.amplitude));
  }
  return highest;
}

TimeFunction read_sum(const support::TomlValue& value, std::string_view unit,
                      const FunctionContext& context) {
  TimeFunction sum;
  for (const support::TomlValue& part : list_parts(value)) {
    sum = TimeFunction::sum(sum, read_function(part, unit, context));
    check_size(value, sum.oscillations().size());
  }
  return sum;
}

// Whether some history in a factor of a product, those from number `first` on, has the unit of the product.
bool has_unit(const support::TomlValue& factor, std::size_t first, const FunctionContext& context) {
  bool has = false;
  for (const HistoryUse& history : std::span(context.histories.used()).subspan(first)) {
    if (history.si_unit.empty()) continue;
    if (history.si_unit != context.unit) {
      throw factor.error(fmt::format("has a history in '{}', expected one of {} or a pure number",
                                     history.unit, list_units(context.unit)));
    }
    has = true;
  }
  return has;
}

// One factor may have the unit; the others are pure numbers.
TimeFunction read_product(const support::TomlValue& value, const FunctionContext& context) {
  TimeFunction product(1.0);
  bool is_dimensional = false;
  for (const support::TomlValue& part : list_parts(value)) {
    const std::size_t first = context.histories.used().size();
    const TimeFunction factor = read_function(part, "", context);
    if (has_unit(part, first, context) && std::exchange(is_dimensional, true)) {
      throw part.error(
          fmt::format("is the second factor with a unit; a product in {} has one", context.unit));
    }
    check_size(value, count_oscillations(product, factor));
    const std::size_t degree = find_degree(product) + find_degree(factor);
    if (degree > kHighestDegree) {
      throw value.error(
          fmt::format("has polynomials of degree {} when it is multiplied out, must have at most {}", degree,
                      kHighestDegree));
    }
    product = TimeFunction::product(product, factor);
  }
  return product;
}

TimeFunction read_pieces(const support::TomlValue& value, std::string_view unit,
                         const FunctionContext& context) {
  std::vector<double> ends;
  std::vector<TimeFunction> parts;
  std::size_t oscillations = 0;
  const std::vector<support::TomlValue> rows = list_parts(value);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const support::TomlTable row = rows[k].table();
    if (k + 1 < rows.size()) {
      ends.push_back(row.number("until", support::any("s")));
      if (k > 0 && !(ends[k] > ends[k - 1])) {
        throw row.at("until").error(
            fmt::format("must come after that of the piece before, {} s, got {} s", ends[k - 1], ends[k]));
      }
    } else if (const std::optional<support::TomlValue> until = row.find("until")) {
      throw until->error("must be left out of the last piece, which goes on for ever");
    }
    const std::size_t first = context.histories.used().size();
    parts.push_back(read_function(row.at("function"), unit, context));
    context.histories.limit(first, k == 0 ? 0.0 : ends[k - 1],
                            k + 1 < rows.size() ? ends[k] : std::numeric_limits<double>::infinity());
    row.reject_unknown_keys();
    oscillations += parts.back().oscillations().size();
    check_size(value, oscillations);
  }
  require_lengths(value, ends);
  return ends.empty() ? parts.front() : TimeFunction::pieces(ends, parts);
}

TimeFunction read_function(const support::TomlValue& value, std::string_view unit,
                           const FunctionContext& context) {
  if (value.is_number()) return TimeFunction(value.number(support::any(unit)));
  if (!value.is_table()) {
    throw value.error(unit.empty() ? std::string("must be a number or a function of time")
                                   : fmt::format("must be a number [{}] or a function of time", unit));
  }
  const support::TomlTable table = value.table();
  constexpr std::array<std::string_view, 8> kWays{"polynomial", "harmonic", "table",   "history",
                                                  "step",       "sum",      "product", "pieces"};
  const std::string_view way = find_only_key(
      table, kWays,
      "one of 'polynomial', 'harmonic', 'table', 'history', 'step', 'sum', 'product' and 'pieces'");
  table.reject_unknown_keys();
  const support::TomlValue content = table.at(way);
  if (way == "harmonic") return read_harmonic(content.table(), unit);
  if (way == "history") return context.histories.read(content.table(), unit, context.use);
  if (way == "step") return read_step(content.table(), unit);
  if (way == "table") return read_table(content, unit, context.use);
  if (way == "sum") return read_sum(content, unit, context);
  if (way == "product") return read_product(content, context);
  if (way == "pieces") return read_pieces(content, unit, context);
  return read_polynomial(content, unit);
}

}  // namespace

TimeFunction read_time_function(const support::TomlValue& value, std::string_view unit, TimeFunctionUse use,
                                HistoryFiles& histories) {
  TimeFunction f = read_function(value, unit, {use, histories, unit});
  if (use == TimeFunctionUse::kForce) return f;
  const std::optional<TimeFunction::Jump> jump = f.find_jump();
  if (!jump) return f;
  const std::string jump_unit = fmt::format("{}{}", unit, jump->is_rate ? "/s" : "");
  throw value.error(fmt::format(
      "must not jump, as it moves bodies: its {} is {:.9g} {} before t = {:.9g} s and {:.9g} {} after",
      jump->is_rate ? "rate" : "value", jump->before, jump_unit, jump->time, jump->after, jump_unit));
}

}  // namespace sprung::dynamics
