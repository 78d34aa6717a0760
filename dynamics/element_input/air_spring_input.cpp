#include "dynamics/element_input/air_spring_input.h"

#include <fmt/format.h>

#include <array>
#include <numbers>
#include <optional>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

// Of the gas: 1 is isothermal, 1.67 adiabatic of a noble gas.
constexpr support::Quantity kExponent{.unit = "", .at_least = 1.0, .at_most = 1.67};
constexpr support::Quantity kDischargeCoefficient{.unit = "", .above = 0.0, .at_most = 1.0};
constexpr double kDischarge = 0.7;  // of a plain orifice

// Opening times discharge coefficient of { diameter, discharge_coefficient }.
double read_orifice(const support::TomlTable& table) {
  const double diameter = table.number("diameter", support::positive("m"));
  const double coefficient = table.number_or("discharge_coefficient", kDischarge, kDischargeCoefficient);
  table.reject_unknown_keys();
  return coefficient * std::numbers::pi / 4.0 * diameter * diameter;
}

// A number, or [[h, A], …]: a smooth curve through the points, level at the ends and beyond.
PiecewisePolynomial read_area(const support::TomlValue& value) {
  if (value.is_number()) return PiecewisePolynomial({value.number(support::positive("m²"))});
  const PointList points = read_point_list(value, support::non_negative("m"), support::positive("m²"));
  PiecewisePolynomial area = PiecewisePolynomial::clamped_spline(points.x, points.y);
  area.continue_straight(points.x.back(), 0.0, false);
  area.continue_straight(points.x.front(), 0.0, true);
  constexpr int kSamples = 50;  // between two points
  for (std::size_t i = 1; i < points.x.size(); ++i) {
    for (int k = 0; k < kSamples; ++k) {
      const double height = points.x[i - 1] + k * (points.x[i] - points.x[i - 1]) / kSamples;
      if (area.value(height) > 0.0) continue;
      throw value.items()[i].error(
          fmt::format("swings the smooth curve through the points to {:.4g} m² at {:.4g} m; add points",
                      area.value(height), height));
    }
  }
  return area;
}

// The gas: its pressure at the design height from that pressure, from a load, or from the load in balance.
void read_gas(const support::TomlTable& table, AirSpring::Parameters& p, ForceDescription& force) {
  static const std::array<std::string, 1> kStatic{"static"};
  p.exponent = table.number_or("exponent", p.exponent, kExponent);
  p.ambient_pressure = table.number_or("ambient_pressure", p.ambient_pressure, support::positive("Pa"));
  p.temperature = table.number_or("temperature", p.temperature, support::positive("K"));
  constexpr std::array<std::string_view, 2> kWays{"gauge_pressure", "load"};
  const std::string_view way = find_only_key(table, kWays, "either 'gauge_pressure' or 'load'");
  const support::TomlValue value = table.at(way);
  double gauge = 0.0;
  if (way == "gauge_pressure") {
    gauge = value.number(support::positive("Pa"));
  } else if (value.is_number()) {
    gauge = value.number(support::positive("N")) / p.effective_area.value(p.design_height);
  } else {
    value.one_of(kStatic);
    if (p.is_coupled)
      throw value.error("must be a number of N where two air springs are coupled, got \"static\"");
    force.static_length = {.key = "load", .length = p.design_height, .location = value.location()};
    gauge = p.ambient_pressure;  // until the balance is known
  }
  p.pressure = p.ambient_pressure + gauge;
}

void read_levelling(const support::TomlTable& table, AirSpring::Parameters& p,
                    const ForceDescription& force) {
  AirSpring::Levelling valve;
  valve.dead_band = table.number("dead_band", support::positive("m"));
  valve.full_opening = table.number("full_opening", support::positive("m"));
  if (!(valve.full_opening > valve.dead_band)) {
    throw table.at("full_opening")
        .error(fmt::format("must be above the dead band of {} m, got {} m", valve.dead_band,
                           valve.full_opening));
  }
  valve.delay = table.number("delay", support::positive("s"));
  valve.supply_pressure = p.ambient_pressure + table.number("supply_gauge_pressure", support::positive("Pa"));
  valve.area = read_orifice(table.at("orifice").table());
  table.reject_unknown_keys();
  if (!force.static_length)
    throw table.error("needs load = \"static\": the valve holds the design height in equilibrium");
  p.levelling = valve;
}

}  // namespace

void read_air_spring(const support::TomlTable& table, ForceDescription& force, HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  force.along_line = true;
  AirSpring::Parameters p;
  p.multiplicity = table.number_or("multiplicity", 1.0, kMultiplicity);
  p.design_height = table.number("design_height", support::positive("m"));
  p.volume = table.number("volume", support::positive("m³"));
  p.effective_area = read_area(table.at("effective_area"));
  if (const std::optional<support::TomlTable> partner = table.find_table("partner")) {
    p.is_coupled = true;
    force.points.push_back(read_point(partner->at("a")));
    force.points.push_back(read_point(partner->at("b")));
    p.line_area = read_orifice(partner->at("line").table());
    partner->reject_unknown_keys();
  }
  if (const std::optional<support::TomlTable> auxiliary = table.find_table("auxiliary")) {
    p.auxiliary_volume = auxiliary->number("volume", support::positive("m³"));
    p.auxiliary_area = read_orifice(auxiliary->at("orifice").table());
    auxiliary->reject_unknown_keys();
  }
  const std::optional<support::TomlTable> levelling = table.find_table("levelling");
  read_gas(table, p, force);
  if (levelling) read_levelling(*levelling, p, force);
  force.parameters = std::move(p);
}

}  // namespace sprung::dynamics
