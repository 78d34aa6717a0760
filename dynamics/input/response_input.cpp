#include "dynamics/input/response_input.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "dynamics/input/spectrum_input.h"

namespace sprung::dynamics {

namespace {

constexpr int kMostFrequencies = 100000;

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
  if (const auto road = table.find_table("road")) request.road = read_spectrum_in_band(*road);
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
