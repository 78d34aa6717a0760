#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "dynamics/functions/find_zero.h"

namespace sprung::dynamics {

/// Finds where the first of several functions of one variable becomes negative, by cubics through four places
/// around it. Allocates nothing. Source: interpolation after Newton; halving where that is slow.
class SwitchSearch {
 public:
  explicit SwitchSearch(Eigen::Index num_switches) : values_(num_switches, kMaxPlaces), new_(num_switches) {}

  static bool crosses(double before, double after) { return before >= 0.0 && after < 0.0; }
  /// Whether one of the values becomes negative.
  template <class Before, class After>
  static bool any_crosses(const Before& before, const After& after) {
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      if (crosses(before[i], after[i])) return true;
    }
    return false;
  }

  /// @param places    2 to 4, increasing
  /// @param values    a column for each of them
  /// @param after     index of a place: functions cross between the place before it and this one
  /// @param evaluate  (theta, values) → values at theta
  /// @return a place after the first zero, by at most `tolerance`
  template <class Evaluate>
  double locate(std::span<const double> places, const Eigen::Ref<const Eigen::MatrixXd>& values, int after,
                double tolerance, const Evaluate& evaluate) {
    begin(places, values, after);
    double width = high() - low();
    for (int iteration = 1; iteration <= kMaxIterations && high() - low() > tolerance; ++iteration) {
      const double zero = predict(0.01 * tolerance);
      if (iteration > 1 && high() - zero <= tolerance) break;
      double theta = zero + 0.5 * tolerance;  // so that it comes to lie behind
      if (iteration % 3 == 0) {
        if (high() - low() > 0.5 * width) theta = 0.5 * (low() + high());
        width = high() - low();
      }
      theta = std::clamp(theta, low() + 0.5 * tolerance, high() - 0.5 * tolerance);
      evaluate(theta, new_);
      take(theta);
    }
    return high();
  }

 private:
  static constexpr int kMaxPlaces = 4, kMaxIterations = 100;

  double low() const { return places_[0]; }
  double high() const { return places_[1]; }

  void begin(std::span<const double> places, const Eigen::Ref<const Eigen::MatrixXd>& values, int after) {
    num_places_ = 0;
    const auto add = [&](int column) {
      places_[static_cast<std::size_t>(num_places_)] = places[static_cast<std::size_t>(column)];
      values_.col(num_places_++) = values.col(column);
    };
    add(after - 1);
    add(after);
    for (int j = 0; j < static_cast<int>(places.size()); ++j) {
      if (j != after - 1 && j != after) add(j);
    }
  }

  // new_ at theta becomes the lower or the upper end; the farthest of the other places is forgotten.
  void take(double theta) {
    const std::size_t end = any_crosses(values_.col(0), new_) ? 1 : 0;
    num_places_ = std::min(num_places_ + 1, kMaxPlaces);
    for (const auto& [to, from] : {std::array<std::size_t, 2>{3, 2}, {2, end}}) {
      places_[to] = places_[from];
      values_.col(static_cast<Eigen::Index>(to)) = values_.col(static_cast<Eigen::Index>(from));
    }
    places_[end] = theta;
    values_.col(static_cast<Eigen::Index>(end)) = new_;
  }

  // First zero of the polynomials through all places, of those functions that cross between low and high.
  double predict(double tolerance) const {
    double first = high();
    for (Eigen::Index i = 0; i < values_.rows(); ++i) {
      if (crosses(values_(i, 0), values_(i, 1))) first = std::min(first, predict(i, tolerance));
    }
    return first;
  }

  double predict(Eigen::Index i, double tolerance) const {
    std::array<double, kMaxPlaces> c{};  // divided differences
    const auto n = static_cast<std::size_t>(num_places_);
    for (std::size_t k = 0; k < n; ++k) c[k] = values_(i, static_cast<Eigen::Index>(k));
    for (std::size_t order = 1; order < n; ++order) {
      for (std::size_t k = n - 1; k >= order; --k)
        c[k] = (c[k] - c[k - 1]) / (places_[k] - places_[k - order]);
    }
    const auto value = [&](double theta) {
      double sum = 0.0;
      for (std::size_t k = n; k-- > 0;) sum = sum * (theta - places_[k]) + c[k];
      return sum;
    };
    return find_zero(value, {low(), values_(i, 0), high(), values_(i, 1)},
                     {.width = tolerance, .max_evaluations = kMaxIterations});
  }

  int num_places_ = 0;
  std::array<double, kMaxPlaces> places_{};  // low, high, and others in the order in which they are forgotten
  Eigen::MatrixXd values_;
  Eigen::VectorXd new_;
};

}  // namespace sprung::dynamics
