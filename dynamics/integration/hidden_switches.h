#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "dynamics/integration/lobatto_points.h"

namespace sprung::dynamics {

/// A switch function along a step, as the cubic through its values at the four Lobatto points.
///
/// Between two points it may become negative and positive again, as where a stop is only just touched. The
/// points alone do not show such a dip. The cubic does, unless the motion is richer than a cubic; the true
/// value at a place between the points shows whether it is.
class SwitchCourse {
 public:
  /// @param values  indexed by the number of the point
  template <class Values>
  explicit SwitchCourse(const Values& values) : v_{values[0], values[1], values[2], values[3]} {}

  /// The cubic at θ.
  double at(double theta) const;
  /// Where the cubic is least, if it becomes negative there and positive again before the first point at
  /// which it is negative; else not a number.
  double dip() const { return bound() >= 0.0 ? std::numeric_limits<double>::quiet_NaN() : find_dip(0.0); }
  /// Whether there may be a dip that the cubic does not show.
  /// @param value  the true one at θ, between the points
  bool may_hide(double theta, double value) const;

 private:
  // Coefficients of the cubic by powers of θ.
  std::array<double, lobatto::kNumNodes> calc_coefficients() const;
  // A lower bound of the cubic: the least of its coefficients by Bernstein polynomials, which add up to 1.
  double bound() const {
    const double second =
        kBernstein[0] * v_[0] + kBernstein[1] * v_[1] + kBernstein[2] * v_[2] + kBernstein[3] * v_[3];
    const double third =
        kBernstein[3] * v_[0] + kBernstein[2] * v_[1] + kBernstein[1] * v_[2] + kBernstein[0] * v_[3];
    return std::min(std::min(v_[0], v_[3]), std::min(second, third));
  }
  double least() const { return std::min(std::min(v_[0], v_[1]), std::min(v_[2], v_[3])); }
  double range() const { return std::max(std::max(v_[0], v_[1]), std::max(v_[2], v_[3])) - least(); }
  double reach() const;
  double find_dip(double doubt) const;

  static constexpr double kRoot5 = 2.23606797749978969;
  static constexpr std::array<double, lobatto::kNumNodes> kBernstein = {
      -1.0, 5.0 / 6.0 * (1.0 + kRoot5), 5.0 / 6.0 * (1.0 - kRoot5), 1.0 / 3.0};
  std::array<double, lobatto::kNumNodes> v_;
};

}  // namespace sprung::dynamics
