#include "dynamics/road/bump_road.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sprung::dynamics {

const std::vector<std::string>& bump_shape_names() {
  static const std::vector<std::string> kNames{"half-sine", "haversine", "triangle", "ramp"};
  return kNames;
}

BumpRoad::BumpRoad(const Parameters& parameters) : parameters_(parameters) {
  if (!(parameters_.length > 0.0)) {
    throw std::invalid_argument(fmt::format("BumpRoad: length must be > 0 m, got {}", parameters_.length));
  }
}

std::string_view BumpRoad::shape() const {
  return bump_shape_names()[static_cast<std::size_t>(parameters_.shape)];
}

ElementDescription BumpRoad::describe() const {
  return {.points = {},
          .parameters = {{"start", parameters_.start, "m"},
                         {"length", parameters_.length, "m"},
                         {"height", parameters_.height, "m"}}};
}

// Segments: flat, the bump (two for the triangle), flat.
int BumpRoad::num_segments() const {
  return parameters_.shape == BumpShape::kTriangle ? 4 : 3;
}

double BumpRoad::segment_end(int k) const {
  if (k == 0) return parameters_.start;
  if (k == num_segments() - 2) return parameters_.start + parameters_.length;
  return parameters_.start + 0.5 * parameters_.length;
}

RoadSample BumpRoad::sample(int segment, double s) const {
  if (segment == 0) return {};
  const double height = parameters_.height;
  const double u = (s - parameters_.start) / parameters_.length;
  const double du = 1.0 / parameters_.length;
  const bool behind = segment == num_segments() - 1;
  switch (parameters_.shape) {
    case BumpShape::kHalfSine: {
      const double pi = std::numbers::pi;
      return behind ? RoadSample{}
                    : RoadSample{height * std::sin(pi * u), height * pi * du * std::cos(pi * u)};
    }
    case BumpShape::kHaversine: {
      const double tau = 2.0 * std::numbers::pi;
      return behind ? RoadSample{}
                    : RoadSample{0.5 * height * (1.0 - std::cos(tau * u)),
                                 0.5 * height * tau * du * std::sin(tau * u)};
    }
    case BumpShape::kTriangle:
      if (behind) return {};
      return segment == 1 ? RoadSample{2.0 * height * u, 2.0 * height * du}
                          : RoadSample{2.0 * height * (1.0 - u), -2.0 * height * du};
    case BumpShape::kRamp:
      return behind ? RoadSample{height, 0.0} : RoadSample{height * u, height * du};
  }
  return {};
}

double BumpRoad::integral(int segment, double s) const {
  if (segment == 0) return 0.0;
  const double u = (s - parameters_.start) / parameters_.length;
  const double scale = parameters_.height * parameters_.length;
  const bool behind = segment == num_segments() - 1;
  const double pi = std::numbers::pi;
  switch (parameters_.shape) {
    case BumpShape::kHalfSine:
      return behind ? 0.0 : -scale / pi * std::cos(pi * u);
    case BumpShape::kHaversine:
      return behind ? 0.0 : 0.5 * scale * (u - std::sin(2.0 * pi * u) / (2.0 * pi));
    case BumpShape::kTriangle:
      if (behind) return 0.0;
      return segment == 1 ? scale * u * u : scale * u * (2.0 - u);
    case BumpShape::kRamp:
      return behind ? scale * u : 0.5 * scale * u * u;
  }
  return 0.0;
}

double BumpRoad::resolution(int segment, double /*s*/) const {
  const bool flat = segment == 0 || segment == num_segments() - 1;
  return flat ? std::numeric_limits<double>::infinity() : 0.125 * parameters_.length;
}

}  // namespace sprung::dynamics
