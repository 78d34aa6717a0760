#include "dynamics/road/table_road.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/functions/clamped_slopes.h"

namespace sprung::dynamics {

namespace {

constexpr double kVisible = 0.01;         // of the range of the four points around an interval
constexpr double kEqualSpacing = 1.0001;  // greatest over least distance of points

// Cubic between two points by heights z and slopes m at both ends, an interval h long; u = 0 … 1.
struct Cubic {
  double z0, z1, m0, m1, h;

  double height(double u) const {
    const double secant = z1 - z0;
    return z0 + u * (h * m0 + u * (3.0 * secant - h * (2.0 * m0 + m1) + u * (h * (m0 + m1) - 2.0 * secant)));
  }
  double slope(double u) const {
    const double secant = (z1 - z0) / h;
    return m0 + u * (2.0 * (3.0 * secant - 2.0 * m0 - m1) + u * 3.0 * (m0 + m1 - 2.0 * secant));
  }
  double integral(double u) const {  // from u = 0
    const double secant = z1 - z0;
    return h * u *
           (z0 + u * (h * m0 / 2.0 + u * ((3.0 * secant - h * (2.0 * m0 + m1)) / 3.0 +
                                          u * (h * (m0 + m1) - 2.0 * secant) / 4.0)));
  }
  // How far the cubic goes beyond the heights of its ends.
  double excursion() const {
    const double secant = (z1 - z0) / h;
    const double a = 3.0 * (m0 + m1 - 2.0 * secant), half_b = 3.0 * secant - 2.0 * m0 - m1, c = m0;
    const double discriminant = half_b * half_b - a * c;
    if (discriminant <= 0.0) return 0.0;
    // Roots of a u² + 2 half_b u + c by the pair of formulas that do not cancel; a may be 0.
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    const auto [low, high] = std::minmax({z0, z1});
    double beyond = 0.0;
    for (const double u : {q / a, c / q}) {
      if (!(u > 0.0 && u < 1.0)) continue;  // NaN and infinity, too
      beyond = std::max({beyond, height(u) - high, low - height(u)});
    }
    return beyond;
  }
};

double limit_slope(double slope, double secant) {
  return std::clamp(slope, std::min(0.0, 3.0 * secant), std::max(0.0, 3.0 * secant));
}

}  // namespace

TableRoad::TableRoad(double start, std::span<const double> s, std::span<const double> height)
    : s_(s.begin(), s.end()), height_(height.begin(), height.end()) {
  if (s.size() < 2 || s.size() != height.size()) {
    throw std::invalid_argument(fmt::format("TableRoad: needs at least 2 points, got {}", s.size()));
  }
  if (!(std::abs(height.front()) <= 1e-9)) {
    throw std::invalid_argument(fmt::format(
        "TableRoad: the first height must be 0 m, as the road before it, got {}", height.front()));
  }
  for (double& value : s_) value += start - s.front();
  spacing_ = std::numeric_limits<double>::infinity();
  double widest = 0.0;
  for (std::size_t i = 1; i < s_.size(); ++i) {
    spacing_ = std::min(spacing_, s_[i] - s_[i - 1]);
    widest = std::max(widest, s_[i] - s_[i - 1]);
  }
  ahead_ = behind_ = DetailLengths(spacing_);
  if (widest > kEqualSpacing * spacing_) {
    ahead_ = DetailLengths::between(s_);
    std::vector<double> backwards(s_.rbegin(), s_.rend());
    for (double& value : backwards) value = -value;
    behind_ = DetailLengths::between(backwards);
  }
  slope_ = calc_clamped_slopes(s_, height_);
  limit_slopes();
  integral_.assign(s_.size(), 0.0);
  for (std::size_t i = 0; i + 1 < s_.size(); ++i) {
    const Cubic cubic{height_[i], height_[i + 1], slope_[i], slope_[i + 1], s_[i + 1] - s_[i]};
    integral_[i + 1] = integral_[i] + cubic.integral(1.0);
  }
}

bool TableRoad::overshoots(std::size_t i) const {
  // The road is level before the first point and after the last one.
  const double before = i > 0 ? height_[i - 1] : height_.front();
  const double after = i + 2 < height_.size() ? height_[i + 2] : height_.back();
  if ((height_[i] - before) * (after - height_[i + 1]) < 0.0)
    return false;  // a crest or a trough between the points
  const auto [low, high] = std::minmax({before, height_[i], height_[i + 1], after});
  const Cubic cubic{height_[i], height_[i + 1], slope_[i], slope_[i + 1], s_[i + 1] - s_[i]};
  return cubic.excursion() > kVisible * (high - low);
}

void TableRoad::limit_slopes() {
  // A limited slope may make a neighbouring interval overshoot. Each pass limits at least one interval for
  // good.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i + 1 < s_.size(); ++i) {
      if (!overshoots(i)) continue;
      const double secant = (height_[i + 1] - height_[i]) / (s_[i + 1] - s_[i]);
      slope_[i] = limit_slope(slope_[i], secant);
      slope_[i + 1] = limit_slope(slope_[i + 1], secant);
      ++num_limited_;
      changed = true;
    }
  }
}

// Most tables have equal distances. The interval is then the one that this distance gives, or one beside it.
std::size_t TableRoad::find_interval(double s) const {
  const auto last = static_cast<double>(s_.size() - 2);
  const double guess = std::floor((s - s_.front()) / (s_.back() - s_.front()) * (last + 1.0));
  const auto i = static_cast<std::size_t>(std::clamp(guess, 0.0, last));
  for (const std::size_t near : {i, i + 1, i - std::min<std::size_t>(i, 1)}) {
    if (near + 1 < s_.size() && s >= s_[near] && s < s_[near + 1]) return near;
  }
  const auto above = std::upper_bound(s_.begin() + 1, s_.end() - 1, s);
  return static_cast<std::size_t>(above - s_.begin()) - 1;
}

ElementDescription TableRoad::describe() const {
  return {.points = {},
          .parameters = {{"distance", s_, "m"}, {"height", height_, "m"}, {"slope", slope_, "1"}}};
}

RoadSample TableRoad::sample(int segment, double s) const {
  if (segment == 0) return {};
  if (segment == 2) return {height_.back(), 0.0};
  const std::size_t i = find_interval(s);
  const Cubic cubic{height_[i], height_[i + 1], slope_[i], slope_[i + 1], s_[i + 1] - s_[i]};
  const double u = (s - s_[i]) / cubic.h;
  return {cubic.height(u), cubic.slope(u)};
}

double TableRoad::integral(int segment, double s) const {
  if (segment == 0) return 0.0;
  if (segment == 2) return height_.back() * s;
  const std::size_t i = find_interval(s);
  const Cubic cubic{height_[i], height_[i + 1], slope_[i], slope_[i + 1], s_[i + 1] - s_[i]};
  return integral_[i] + cubic.integral((s - s_[i]) / cubic.h);
}

double TableRoad::resolution(int segment, double s) const {
  if (segment != 1) return std::numeric_limits<double>::infinity();
  return std::min(ahead_.calc_longest_step(s), behind_.calc_longest_step(-s));
}

double TableRoad::finest_resolution(int segment) const {
  return segment == 1 ? spacing_ : std::numeric_limits<double>::infinity();
}

}  // namespace sprung::dynamics
