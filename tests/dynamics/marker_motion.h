#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/marker.h"

namespace sprung::test {

/// A marker that accelerates steadily.
struct MarkerMotion {
  Eigen::Vector2d r, v, a;
  double angle, omega, alpha;

  dynamics::MarkerState at(double t) const {
    dynamics::MarkerState state;
    state.r = r + t * v + 0.5 * t * t * a;
    state.v = v + t * a;
    state.angle = angle + t * omega + 0.5 * t * t * alpha;
    state.omega = omega + t * alpha;
    return state;
  }
  Eigen::Vector3d velocity() const { return {v.x(), v.y(), omega}; }
  Eigen::Vector3d acceleration() const { return {a.x(), a.y(), alpha}; }
};

/// Step of the differences below [s]: their errors are about 1e-12 and 1e-10 of values near 1.
inline constexpr double kDifferenceStep = 1e-3;

/// The derivative of a function of time at t = 0, by differences of fourth order.
template <class Function>
auto calc_rate(const Function& f) -> decltype(f(0.0)) {
  constexpr double h = kDifferenceStep;
  return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12.0 * h);
}

/// Its second derivative.
template <class Function>
auto calc_second_rate(const Function& f) -> decltype(f(0.0)) {
  constexpr double h = kDifferenceStep;
  return (16.0 * (f(h) + f(-h)) - (f(2 * h) + f(-2 * h)) - 30.0 * f(0.0)) / (12.0 * h * h);
}

}  // namespace sprung::test
