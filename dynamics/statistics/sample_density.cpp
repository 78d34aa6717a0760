#include "dynamics/statistics/sample_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sprung::dynamics {

void SampleDensity::add_sample(double value) {
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_.back() = value;
  ++num_samples_;
  sum_of_squares_ += value * value;
  if (num_samples_ > 1) sum_of_steps_ += (value - last_[3]) * (value - last_[3]);
  const bool is_first = num_samples_ == 1;
  smallest_ = is_first ? value : std::min(smallest_, value);
  largest_ = is_first ? value : std::max(largest_, value);
  if (num_samples_ < std::ssize(last_)) return;
  const double cubic = (4.0 * (last_[1] + last_[3]) - last_[0] - last_[4]) / 6.0;
  sum_of_differences_ += (last_[2] - cubic) * (last_[2] - cubic);
}

void SampleDensity::add_between(double value) {
  smallest_between_ = std::min(smallest_between_, value);
  largest_between_ = std::max(largest_between_, value);
}

double SampleDensity::roughness(double floor) const {
  const auto num_differences = static_cast<double>(num_samples_ - std::ssize(last_) + 1);
  if (num_differences < 1.0) return 0.0;
  return std::sqrt(sum_of_differences_ / std::max(sum_of_squares_, num_differences * floor * floor));
}

double SampleDensity::step_rms() const {
  return num_samples_ > 1 ? std::sqrt(sum_of_steps_ / static_cast<double>(num_samples_ - 1)) : 0.0;
}

double SampleDensity::roughness_by_steps(double floor) const {
  const auto num_differences = static_cast<double>(num_samples_ - std::ssize(last_) + 1);
  if (num_differences < 1.0) return 0.0;
  const double share = std::sqrt(sum_of_differences_ / num_differences) / std::max(step_rms(), floor);
  return 2.0 / 3.0 * std::pow(3.0 / std::numbers::sqrt2 * share, 4.0 / 3.0);
}

double SampleDensity::farthest_between() const {
  return smallest_ - smallest_between_ > largest_between_ - largest_ ? smallest_between_ : largest_between_;
}

double SampleDensity::missed(double floor) const {
  const double outside = std::max({smallest_ - smallest_between_, largest_between_ - largest_, 0.0});
  return outside / std::max({floor, -smallest_, largest_, std::abs(farthest_between())});
}

}  // namespace sprung::dynamics
