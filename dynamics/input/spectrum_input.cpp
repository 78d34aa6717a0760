#include "dynamics/input/spectrum_input.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

constexpr std::array kIsoBand{0.011, 2.83};  // 1/m, of the spectra that ISO 8608 reports

RoadSpectrum read_road_class(const support::TomlValue& value) {
  static const std::array<std::string, 8> kClasses{"A", "B", "C", "D", "E", "F", "G", "H"};
  return RoadSpectrum::power_law(calc_iso_density(value.one_of(kClasses)[0]), 2.0);
}

double read_exponent(const support::TomlTable& table) {
  return table.number_or("exponent", 2.0, support::any(""));
}

// Reads the spectrum that one of the keys gives. An r.m.s. value leaves its scale open.
RoadSpectrum read_spectrum(const support::TomlTable& table, std::string_view way) {
  if (const auto exponent = table.find("exponent"); exponent && way != "density" && way != "rms")
    throw exponent->error(fmt::format("belongs to a power law, which '{}' does not give", way));
  if (way == "class") return read_road_class(table.at("class"));
  if (way == "table") {
    const PointList points =
        read_point_list(table.at("table"), support::positive("1/m"), support::positive("m^3"));
    return RoadSpectrum::through_points(points.x, points.y);
  }
  const double density = way == "rms" ? 1.0 : table.number("density", support::positive("m^3"));
  return RoadSpectrum::power_law(density, read_exponent(table));
}

std::optional<std::array<double, 2>> read_band(const support::TomlTable& table,
                                               const support::Quantity& quantity) {
  const std::optional<support::TomlValue> band = table.find("band");
  if (!band) return std::nullopt;
  const std::vector<double> limits = band->numbers(quantity, 2);
  if (!(limits[1] > limits[0]))
    throw band->error(fmt::format("must ascend, got {} to {} 1/m", limits[0], limits[1]));
  return std::array{limits[0], limits[1]};
}

}  // namespace

RoadSpectrum read_spectrum_in_band(const support::TomlTable& table) {
  constexpr std::array<std::string_view, 3> kWays{"class", "density", "table"};
  table.find("band");
  table.find("exponent");
  RoadSpectrum spectrum =
      read_spectrum(table, find_only_key(table, kWays, "either a 'class', or a 'density', or a 'table'"));
  if (const auto band = read_band(table, support::non_negative("1/m")))
    spectrum.limit_to((*band)[0], (*band)[1]);
  table.reject_unknown_keys();
  return spectrum;
}

RandomRoad read_random_road(const support::TomlTable& table) {
  constexpr std::array<std::string_view, 4> kWays{"class", "density", "table", "rms"};
  for (const char* known : {"band", "exponent", "length", "ease", "seed"}) table.find(known);
  const std::string_view way =
      find_only_key(table, kWays, "either a 'class', or a 'density', or a 'table', or an 'rms'");
  RandomRoad road{.spectrum = read_spectrum(table, way)};
  const std::vector<double> ends = road.spectrum.breaks();
  if (const auto band = read_band(table, support::positive("1/m"))) {
    road.lowest = (*band)[0];
    road.highest = (*band)[1];
  } else if (way == "class") {
    road.lowest = kIsoBand[0];
    road.highest = kIsoBand[1];
  } else if (way == "table") {
    road.lowest = ends.front();
    road.highest = ends.back();
  } else {
    throw table.error(fmt::format("must have a 'band' beside '{}'", way));
  }
  road.length = table.number("length", support::positive("m"));
  if (way == "rms") road.rms = table.number("rms", support::positive("m"));
  if (const auto ease = table.find("ease")) {
    road.ease = ease->number(support::non_negative("m"));
    if (!(2.0 * road.ease < road.length)) {
      throw ease->error(
          fmt::format("must be below half of the length {} m, got {} m", road.length, road.ease));
    }
  }
  road.seed =
      static_cast<std::uint64_t>(table.integer_or("seed", 1, 0, std::numeric_limits<std::int64_t>::max()));
  return road;
}

}  // namespace sprung::dynamics
