#include "dynamics/integration/hidden_switches.h"

#include <cmath>

namespace sprung::dynamics {

namespace {

using lobatto::kNumNodes;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-3;   // of the range: a smaller dip does not count
constexpr double kUnresolved = 0.1;  // of the range: with a larger error the cubic says nothing of a function
constexpr double kDoubt = 2.0;       // error elsewhere, over the error at the place of the true value
constexpr double kSwingOfRange = 2.0,
                 kSwingOfError = 4.0;  // a bound of its swing beyond the values at the points

double calc_cubic(const std::array<double, kNumNodes>& c, double theta) {
  return c[0] + theta * (c[1] + theta * (c[2] + theta * c[3]));
}

}  // namespace

std::array<double, kNumNodes> SwitchCourse::calc_coefficients() const {
  const double rise = v_[3] - v_[0], middle = 5.0 / 8.0 * (v_[1] + v_[2]) - 1.0 / 8.0 * (v_[0] + v_[3]);
  const double cubic = 5.0 * (rise - kRoot5 * (v_[2] - v_[1]));
  const double linear = 4.0 * (middle - v_[0]) - rise + 0.5 * cubic;
  return {v_[0], linear, rise - linear - cubic, cubic};
}

double SwitchCourse::at(double theta) const {
  return calc_cubic(calc_coefficients(), theta);
}

// θ up to which no point is negative.
double SwitchCourse::reach() const {
  for (std::size_t j = 1; j < kNumNodes; ++j) {
    if (v_[j] < 0.0) return lobatto::node(static_cast<int>(j) - 1);
  }
  return 1.0;
}

// The place of a dip of the cubic lowered by `doubt`; not a number where there is none.
double SwitchCourse::find_dip(double doubt) const {
  const double limit = doubt - kRounding * range();
  if (bound() >= limit) return kNone;
  // The root of the slope with s″ = 2√D > 0, by the formula in which nothing cancels.
  const std::array<double, kNumNodes> c = calc_coefficients();
  const double D = c[2] * c[2] - 3.0 * c[1] * c[3];
  if (!(D > 0.0)) return kNone;
  const double theta = c[2] > 0.0 ? -c[1] / (c[2] + std::sqrt(D)) : (std::sqrt(D) - c[2]) / (3.0 * c[3]);
  return theta > 0.0 && theta < reach() && calc_cubic(c, theta) < limit ? theta : kNone;
}

bool SwitchCourse::may_hide(double theta, double value) const {
  const double error = std::abs(value - at(theta));
  if (theta < reach() && value < -kRounding * range()) return true;
  if (std::isfinite(find_dip(kDoubt * error))) return true;
  return error > kUnresolved * range() && least() < kSwingOfRange * range() + kSwingOfError * error;
}

}  // namespace sprung::dynamics
