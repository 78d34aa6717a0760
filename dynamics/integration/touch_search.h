#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "dynamics/integration/hidden_switches.h"
#include "dynamics/integration/switch_search.h"

namespace sprung::dynamics {

/// Finds switch functions that become negative and positive again within a step at whose ends none is
/// negative, as where a body that flies freely touches a stop: for methods that evaluate switches at the ends
/// of steps only. It evaluates between them only where the functions' slopes let them reach zero. Allocates
/// nothing after it is made.
class TouchSearch {
 public:
  explicit TouchSearch(Eigen::Index num_switches)
      : values_(num_switches, lobatto::kNumNodes),
        slopes_(num_switches),
        at_dip_(num_switches, 2),
        new_(num_switches),
        search_(num_switches) {
    forget();
  }

  /// Says that no step precedes the next one.
  void forget() { slopes_.setConstant(std::numeric_limits<double>::infinity()); }

  /// @param begin, end  values of the functions at the ends of the step
  /// @param length      of the step, > 0 [s]
  /// @param tolerance   of the place, of the step
  /// @param evaluate    (theta, values) → values at theta, 0 to 1
  /// @return a place behind the first zero, by at most the tolerance; none if no function becomes negative
  template <class Begin, class End, class Evaluate>
  std::optional<double> find(const Begin& begin, const End& end, double length, double tolerance,
                             const Evaluate& evaluate) {
    values_.col(0) = begin.cwiseMax(0.0);
    values_.col(kLast) = end;
    const bool may_reach_zero = may_touch(length);
    slopes_ = (end - begin) / length;
    if (!may_reach_zero) return std::nullopt;
    for (const int j : {1, 2}) {
      evaluate(lobatto::node(j), new_);
      values_.col(j) = new_;
    }
    for (int j = 1; j < kLast; ++j) {
      if (!SwitchSearch::any_crosses(values_.col(j - 1), values_.col(j))) continue;
      return search_.locate(lobatto::nodes(), values_, j, tolerance, evaluate);
    }
    const double dip = find_dip();
    if (!std::isfinite(dip)) return std::nullopt;
    int before = kLast - 1;
    while (lobatto::node(before) >= dip) --before;
    evaluate(dip, new_);
    at_dip_.col(0) = values_.col(before);
    at_dip_.col(1) = new_;
    if (!SwitchSearch::any_crosses(at_dip_.col(0), at_dip_.col(1))) return std::nullopt;
    return search_.locate(std::array{lobatto::node(before), dip}, at_dip_, 1, tolerance, evaluate);
  }

 private:
  static constexpr int kLast = lobatto::kNumNodes - 1;

  // Whether the slope of a function, in this step or the one before, can take it to zero within the step.
  bool may_touch(double length) const {
    for (Eigen::Index i = 0; i < slopes_.size(); ++i) {
      const double change = std::abs(values_(i, kLast) - values_(i, 0));
      if (std::min(values_(i, 0), values_(i, kLast)) <= std::max(change, std::abs(slopes_[i]) * length))
        return true;
    }
    return false;
  }

  double find_dip() const {
    double first = std::numeric_limits<double>::quiet_NaN();
    for (Eigen::Index i = 0; i < values_.rows(); ++i)
      first = std::fmin(first, SwitchCourse(values_.row(i)).dip());
    return first;
  }

  Eigen::MatrixXd values_;  // at the Lobatto points of the step
  Eigen::VectorXd slopes_;  // mean, of the last step [1/s]
  Eigen::MatrixXd at_dip_;  // before a dip, and at it
  Eigen::VectorXd new_;
  SwitchSearch search_;
};

}  // namespace sprung::dynamics
