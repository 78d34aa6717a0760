#pragma once

#include <cmath>

namespace sprung::dynamics {

/// Two arguments of a function and its values there, which have opposite signs; the value at b may be 0.
struct ZeroBracket {
  double a, value_a;
  double b, value_b;
};

/// The search for a zero ends when the bracket is no wider than `width`, or |f| is no larger than `value`.
struct ZeroTolerance {
  double width = 0.0, value = 0.0;
  int max_evaluations = 100;
};

/// A zero of a continuous function of one variable by the Illinois rule: secant steps, in which the value at
/// an end that stays is halved.
/// @return the argument evaluated last; b if none was
/// Source: [Dowell & Jarratt 1971]
template <class Function>
double find_zero(const Function& function, ZeroBracket ends, const ZeroTolerance& tolerance) {
  auto [a, value_a, b, value_b] = ends;
  for (int i = 0; i < tolerance.max_evaluations; ++i) {
    if (std::abs(value_b) <= tolerance.value || std::abs(b - a) <= tolerance.width) break;
    const double x = b - value_b * (b - a) / (value_b - value_a);
    const double value = function(x);
    if (value * value_b < 0.0) {
      a = b;
      value_a = value_b;
    } else {
      value_a *= 0.5;
    }
    b = x;
    value_b = value;
  }
  return b;
}

}  // namespace sprung::dynamics
