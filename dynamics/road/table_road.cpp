#include "dynamics/road/table_road.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sprung::dynamics {

TableRoad::TableRoad(double start, std::span<const double> s, std::span<const double> height) : start_(start) {
  if (s.size() < 2 || s.size() != height.size()) {
    throw std::invalid_argument(fmt::format("TableRoad: needs at least 2 points, got {}", s.size()));
  }
  if (!(std::abs(height.front()) <= 1e-9)) {
    throw std::invalid_argument(
        fmt::format("TableRoad: the first height must be 0 m, as the road before it, got {}", height.front()));
  }
  std::vector<double> shifted(s.begin(), s.end());
  for (double& value : shifted) value += start - s.front();
  end_ = shifted.back();
  end_height_ = height.back();
  spacing_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < shifted.size(); ++i) spacing_ = std::min(spacing_, shifted[i] - shifted[i - 1]);
  height_ = PiecewisePolynomial::clamped_spline(shifted, height);
  slope_ = height_.derivative();
}

RoadSample TableRoad::sample(int segment, double s) const {
  if (segment == 0) return {};
  if (segment == 2) return {end_height_, 0.0};
  return {height_.value(s), slope_.value(s)};
}

double TableRoad::resolution(int segment, double /*s*/) const {
  return segment == 1 ? spacing_ : std::numeric_limits<double>::infinity();
}

}  // namespace sprung::dynamics
