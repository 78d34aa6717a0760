#include "dynamics/input/response_input.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

constexpr int kMostFrequencies = 100000;

RoadSpectrum read_road_class(const support::TomlValue& value) {
  static const std::array<std::string, 8> kClasses{"A", "B", "C", "D", "E", "F", "G", "H"};
  return RoadSpectrum::power_law(calc_iso_density(value.one_of(kClasses)[0]), 2.0);
}

RoadSpectrum read_spectrum(const support::TomlTable& table) {
  constexpr std::array<std::string_view, 3> kWays{"class", "density", "table"};
  table.find("band");
  const std::optional<support::TomlValue> exponent = table.find("exponent");
  const std::string_view way = find_only_key(table, kWays, "either a 'class', or a 'density', or a 'table'");
  if (exponent && way != "density") throw exponent->error("goes with 'density' only");
  RoadSpectrum spectrum = [&] {
    if (way == "class") return read_road_class(table.at("class"));
    if (way == "table") {
      const PointList points =
          read_point_list(table.at("table"), support::positive("1/m"), support::positive("m^3"));
      return RoadSpectrum::through_points(points.x, points.y);
    }
    return RoadSpectrum::power_law(table.number("density", support::positive("m^3")),
                                   table.number_or("exponent", 2.0, support::any("")));
  }();
  if (const std::optional<support::TomlValue> band = table.find("band")) {
    const std::vector<double> limits = band->numbers(support::non_negative("1/m"), 2);
    if (!(limits[1] > limits[0])) {
      throw band->error(fmt::format("must ascend, got {} to {} 1/m", limits[0], limits[1]));
    }
    spectrum.limit_to(limits[0], limits[1]);
  }
  table.reject_unknown_keys();
  return spectrum;
}

}  // namespace

ResponseRequest read_response(const support::TomlTable& table) {
  static const std::array<std::string, 2> kSpacings{"logarithmic", "linear"};  // as ResponseRequest::Spacing
  ResponseRequest request;
  request.location = table.location();
  request.from = table.number_or("from", request.from, support::positive("Hz"));
  request.to = table.number_or("to", request.to, support::positive("Hz"));
  if (!(request.to > request.from)) {
    throw table.error(fmt::format("must go from a lower to a higher frequency, got from {} Hz to {} Hz",
                                  request.from, request.to));
  }
  request.number = static_cast<int>(table.integer_or("number", request.number, 2, kMostFrequencies));
  if (const std::optional<support::TomlValue> spacing = table.find("spacing")) {
    request.spacing = spacing->one_of(kSpacings) == kSpacings[0] ? ResponseRequest::Spacing::kLogarithmic
                                                                 : ResponseRequest::Spacing::kLinear;
  }
  if (const std::optional<support::TomlValue> points = table.find("points")) {
    for (const support::TomlValue& item : points->items()) request.points.push_back(read_point(item));
    if (request.points.empty()) throw points->error("must name at least one point \"body.point\"");
  }
  if (const auto road = table.find_table("road")) request.road = read_spectrum(*road);
  table.reject_unknown_keys();
  return request;
}

std::vector<double> list_frequencies(const ResponseRequest& request) {
  std::vector<double> frequencies{request.from};
  for (int i = 1; i + 1 < request.number; ++i) {
    const double u = static_cast<double>(i) / (request.number - 1);
    frequencies.push_back(request.spacing == ResponseRequest::Spacing::kLinear
                              ? request.from + u * (request.to - request.from)
                              : request.from * std::pow(request.to / request.from, u));
  }
  frequencies.push_back(request.to);
  return frequencies;
}

}  // namespace sprung::dynamics
