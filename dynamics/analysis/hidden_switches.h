#pragma once

#include <array>
#include <limits>

#include "dynamics/analysis/lobatto_step.h"

namespace sprung::dynamics {

/// A switch function along a step, as the cubic through its values at the four Lobatto points.
///
/// Between two points it may become negative and positive again, as where a stop is only just touched. The
/// points alone do not show that. The cubic does, where the motion is no richer than a cubic; whether it is,
/// the true value at a place between the points tells.
class SwitchCourse {
 public:
  explicit SwitchCourse(const lobatto::NodeWeights& values);

  /// The cubic at θ.
  double at(double theta) const { return c_[0] + theta * (c_[1] + theta * (c_[2] + theta * c_[3])); }
  /// Where the cubic is least, if it becomes negative there and positive again before the first point at
  /// which it is negative; else not a number.
  double dip() const { return is_dip(0.0) ? minimum_ : std::numeric_limits<double>::quiet_NaN(); }
  /// Whether there may be a dip that the cubic does not show.
  /// @param value  the true one at θ, between the points
  bool may_hide(double theta, double value) const;

 private:
  bool is_dip(double doubt) const;

  std::array<double, lobatto::kNumNodes> c_{};                 // by powers of θ
  double range_ = 0.0, least_ = 0.0;                           // of the values at the points
  double reach_ = 1.0;                                         // θ up to which no point is negative
  double minimum_ = std::numeric_limits<double>::quiet_NaN();  // θ of it, between 0 and reach_
};

}  // namespace sprung::dynamics
