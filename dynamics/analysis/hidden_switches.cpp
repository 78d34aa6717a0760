#include "dynamics/analysis/hidden_switches.h"

#include <cmath>

namespace sprung::dynamics {

namespace {

using lobatto::kNumNodes;

constexpr double kRounding = 1e-3;   // of the range: dips that count for none
constexpr double kUnresolved = 0.1;  // of the range: an error at which the cubic says nothing of a function
constexpr double kDoubt = 2.0;       // error elsewhere, of that where the true value is known
constexpr double kSwingOfRange = 2.0, kSwingOfError = 4.0;  // how far it may swing beyond the points

}  // namespace

SwitchCourse::SwitchCourse(const lobatto::NodeWeights& values)
    : range_(values.maxCoeff() - values.minCoeff()), least_(values.minCoeff()) {
  static const lobatto::NodeWeights kMiddle = lobatto::cubic_weights(0.5),
                                    kThird = lobatto::third_degree_weights();
  const double middle = kMiddle.dot(values), rise = values[kNumNodes - 1] - values[0];
  c_[0] = values[0];
  c_[3] = kThird.dot(values);
  c_[1] = 4.0 * (middle - values[0]) - rise + 0.5 * c_[3];
  c_[2] = rise - c_[1] - c_[3];
  for (int j = 1; j < kNumNodes; ++j) {
    if (values[j] >= 0.0) continue;
    reach_ = lobatto::node(j - 1);
    break;
  }
  // Of the two roots of the slope the one with s″ = 2√D > 0, so that nothing cancels.
  const double D = c_[2] * c_[2] - 3.0 * c_[1] * c_[3];
  if (!(D > 0.0)) return;
  const double theta = c_[2] > 0.0 ? -c_[1] / (c_[2] + std::sqrt(D)) : (std::sqrt(D) - c_[2]) / (3.0 * c_[3]);
  if (theta > 0.0 && theta < reach_) minimum_ = theta;
}

bool SwitchCourse::is_dip(double doubt) const {
  return std::isfinite(minimum_) && at(minimum_) < doubt - kRounding * range_;
}

bool SwitchCourse::may_hide(double theta, double value) const {
  const double error = std::abs(value - at(theta));
  if (theta < reach_ && value < -kRounding * range_) return true;
  if (is_dip(kDoubt * error)) return true;
  return error > kUnresolved * range_ && least_ < kSwingOfRange * range_ + kSwingOfError * error;
}

}  // namespace sprung::dynamics
