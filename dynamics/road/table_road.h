#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A road through measured or generated points: flat, then a smooth curve, then level at the height of the
/// last point.
///
/// The curve is the complete cubic spline through the points: twice continuously differentiable, level at
/// both ends. Over points `spacing` apart on a smooth road z(s) it is wrong by at most 5/384 · spacing⁴ ·
/// max|z⁗|: on a sine with 6 points on each wave by 1.6 % of its amplitude, with 12 points by 0.1 %. [Hall &
/// Meyer 1976, theorem 2]
///
/// Around a kerb such a spline swings past the points. Where it would leave the heights at both ends of an
/// interval by more than 1 % of the range of the four points around, though these points neither rise and
/// then fall nor fall and then rise, its slopes at both ends are limited to what keeps a cubic monotone (with
/// the sign of the secant and at most three times as steep): the second derivative may jump at these two
/// points, and the curve stays between their heights. [Fritsch & Carlson 1980, section 3]
class TableRoad final : public Road {
 public:
  /// @param start    where the first point lies [m]
  /// @param s        ascending, at least 2 [m], counted from any origin
  /// @param height   as many [m]; the first is 0, as the road before it
  /// @throws std::invalid_argument
  TableRoad(double start, std::span<const double> s, std::span<const double> height);

  std::string_view shape() const override { return "table"; }
  ElementDescription describe() const override;
  int num_segments() const override { return 3; }
  double segment_end(int k) const override { return k == 0 ? s_.front() : s_.back(); }
  RoadSample sample(int segment, double s) const override;
  double integral(int segment, double s) const override;
  double resolution(int segment, double s) const override;

  /// In how many intervals between points the spline was limited.
  std::size_t num_limited() const { return num_limited_; }

 private:
  std::size_t find_interval(double s) const;
  bool overshoots(std::size_t interval) const;
  void limit_slopes();

  std::vector<double> s_, height_, slope_;  // at the points
  std::vector<double> integral_;            // from the first point to each
  std::size_t num_limited_ = 0;
  double spacing_;  // the smallest
};

}  // namespace sprung::dynamics
