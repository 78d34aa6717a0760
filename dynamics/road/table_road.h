#pragma once

#include <span>

#include "dynamics/forces/piecewise_polynomial.h"
#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// A road through measured or generated points: flat, then a cubic spline (twice continuously differentiable, level
/// at both ends), then level at the height of the last point.
class TableRoad final : public Road {
 public:
  /// @param start    where the first point lies [m]
  /// @param s        ascending, at least 2 [m], counted from any origin
  /// @param height   as many [m]; the first is 0, as the road before it
  /// @throws std::invalid_argument
  TableRoad(double start, std::span<const double> s, std::span<const double> height);

  int num_segments() const override { return 3; }
  double segment_end(int k) const override { return k == 0 ? start_ : end_; }
  RoadSample sample(int segment, double s) const override;
  double resolution(int segment, double s) const override;

 private:
  double start_, end_, end_height_, spacing_;
  PiecewisePolynomial height_, slope_;
};

}  // namespace sprung::dynamics
