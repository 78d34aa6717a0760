#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dynamics/functions/detail_lengths.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A road through measured or generated points. It is flat before the first point, a smooth curve between the
/// points, and stays at the height of the last one.
///
/// The curve is the complete cubic spline through the points: twice continuously differentiable, level at
/// both ends. Through points at a distance Δ on a smooth road z(s), its error is at most 5/384 · Δ⁴ ·
/// max|z⁗|: on a sine with 6 points on each wave 1.6 % of the amplitude, with 12 points 0.1 %. [Hall & Meyer
/// 1976, theorem 2]
///
/// At a kerb such a spline swings past the points. In an interval that is part of a kerb ("Shape" in the
/// README), the slopes at both ends are limited so that the cubic is monotone. The curve then stays between
/// the heights of the two points, where its second derivative may jump. [Fritsch & Carlson 1980, section 3]
class TableRoad final : public Road {
 public:
  /// @param start    s of the first point on the road [m]
  /// @param s        ascending, at least 2 [m], counted from any origin
  /// @param height   as many [m]; the first is 0, the height of the road before it
  /// @throws std::invalid_argument
  TableRoad(double start, std::span<const double> s, std::span<const double> height);

  std::string_view shape() const override { return "table"; }
  ElementDescription describe() const override;
  int num_segments() const override { return 3; }
  double segment_end(int k) const override { return k == 0 ? s_.front() : s_.back(); }
  RoadSample sample(int segment, double s) const override;
  double integral(int segment, double s) const override;
  double resolution(int segment, double s) const override;
  double finest_resolution(int segment) const override;

  /// Number of intervals in which the slopes were limited.
  std::size_t num_limited() const { return num_limited_; }

 private:
  std::size_t find_interval(double s) const;
  bool overshoots(std::size_t interval) const;
  void limit_slopes();

  std::vector<double> s_, height_, slope_;  // at the points
  std::vector<double> integral_;            // from the first point to each
  std::size_t num_limited_ = 0;
  double spacing_;                // the smallest
  DetailLengths ahead_, behind_;  // distances of points along s and along −s; where they are equal, spacing_
};

}  // namespace sprung::dynamics
