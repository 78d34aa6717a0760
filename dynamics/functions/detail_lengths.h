#pragma once

#include <limits>
#include <span>
#include <vector>

namespace sprung::dynamics {

/// How long the details of a function of time are: an eighth of a period, the distance of two samples.
/// Piecewise constant in time. An integrator should pass over no detail in one step (functions, eq. 3).
/// Checked by tests/dynamics/functions/detail_lengths_test.cpp
class DetailLengths {
 public:
  /// The same always; infinite where there are no details. @param length  > 0 [s]
  explicit DetailLengths(double length = std::numeric_limits<double>::infinity()) : lengths_{length} {}
  /// From each time to the next, their distance; infinite outside. @param times  ascending, at least 2 [s]
  static DetailLengths between(std::span<const double> times);

  /// The shorter of both at each time.
  static DetailLengths shorter(const DetailLengths& a, const DetailLengths& b);
  /// parts[k] between ends[k − 1] and ends[k]; parts[0] before ends[0], the last part after the last end.
  static DetailLengths join(std::span<const double> ends, std::span<const DetailLengths> parts);

  /// The shortest [s].
  double shortest() const;
  /// The longest step from a time that passes over no detail [s].
  double calc_longest_step(double time) const;

 private:
  void add(double start, double length);  // from `start` on; equal lengths are one piece

  std::vector<double> starts_;   // of the pieces behind the first, ascending [s]
  std::vector<double> lengths_;  // one more [s]
};

}  // namespace sprung::dynamics
