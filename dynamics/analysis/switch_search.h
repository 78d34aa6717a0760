#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace sprung::dynamics {

/// Finds the first zero of several functions of one variable between two places, by the Illinois rule.
/// Allocates nothing. Source: [Dowell & Jarratt 1971]
class SwitchSearch {
 public:
  explicit SwitchSearch(Eigen::Index num_switches) {
    low_ = high_ = between_ = Eigen::VectorXd::Zero(num_switches);
  }

  /// Whether one of the values changes its sign, or becomes zero.
  template <class Before, class After>
  static bool any_crosses(const Before& before, const After& after) {
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      if (crosses(before[i], after[i])) return true;
    }
    return false;
  }

  /// @param at_low, at_high  the values there; some of them cross
  /// @param evaluate         (theta, values) → values at theta
  /// @return a place within `tolerance` behind the first zero
  template <class Evaluate>
  double locate(double low, double high, double tolerance, const Eigen::Ref<const Eigen::VectorXd>& at_low,
                const Eigen::Ref<const Eigen::VectorXd>& at_high, const Evaluate& evaluate) {
    low_ = at_low;
    high_ = at_high;
    double weight = 1.0;  // of the value at `high`
    int last_moved = 0;
    for (int iteration = 0; iteration < kMaxIterations && high - low > tolerance; ++iteration) {
      double theta = high;
      for (Eigen::Index i = 0; i < low_.size(); ++i) {
        if (!crosses(low_[i], high_[i])) continue;
        theta = std::min(theta, low + (high - low) * low_[i] / (low_[i] - weight * high_[i]));
      }
      theta = std::clamp(theta, low + 0.5 * tolerance, high - 0.5 * tolerance);
      evaluate(theta, between_);
      const bool is_behind = any_crosses(low_, between_);
      (is_behind ? high : low) = theta;
      (is_behind ? high_ : low_).swap(between_);
      const int moved = is_behind ? 1 : -1;
      weight = moved != last_moved ? 1.0 : is_behind ? 2.0 * weight : 0.5 * weight;
      last_moved = moved;
    }
    return high;
  }

 private:
  static constexpr int kMaxIterations = 100;
  static bool crosses(double before, double after) {
    return before * after < 0.0 || (after == 0.0 && before != 0.0);
  }

  Eigen::VectorXd low_, high_, between_;
};

}  // namespace sprung::dynamics
