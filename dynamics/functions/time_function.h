#pragma once

#include <limits>
#include <span>
#include <vector>

#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A function of time with its first two derivatives: applied forces, prescribed motion (functions, eq. 1).
/// Smooth between its breaks; at a break the formula of what follows holds. The integrator steps to every
/// break exactly and starts anew there.
class TimeFunction {
 public:
  TimeFunction() = default;
  /// The same value always.
  explicit TimeFunction(double constant) : TimeFunction(PiecewisePolynomial({constant})) {}

  /// Σ a_k t^k
  static TimeFunction polynomial(std::vector<double> coefficients);

  struct Harmonic {
    double mean = 0.0;
    double amplitude = 0.0;
    double frequency_hz = 0.0;  ///< > 0
    double phase = 0.0;         ///< [rad]
  };
  /// mean + amplitude sin(2π frequency t + phase)
  static TimeFunction harmonic(const Harmonic& parameters);

  /// Straight lines through points, level before the first and after the last; kinks at all of them.
  /// @param t ascending, at least 2 [s]; x as many
  /// @throws std::invalid_argument
  static TimeFunction lines(std::span<const double> t, std::span<const double> x);
  /// Cubic spline through points, twice continuously differentiable, starting and ending level and level
  /// outside.
  /// @param t ascending, at least 2 [s]; x as many
  /// @throws std::invalid_argument
  static TimeFunction spline(std::span<const double> t, std::span<const double> x);

  struct Step {
    double before = 0.0, after = 0.0;
    double start = 0.0, end = 0.0;  ///< start < end [s]
  };
  /// before + (after − before) (10u³ − 15u⁴ + 6u⁵), u = (t − start)/(end − start) from 0 to 1: two continuous
  /// derivatives everywhere.
  /// @throws std::invalid_argument unless start < end
  static TimeFunction smooth_step(const Step& parameters);

  double value(double time) const;
  double rate(double time) const;
  double acceleration(double time) const;
  bool is_constant() const;

  /// The function is the sum of these two; the second is none where its amplitude is 0.
  const PiecewisePolynomial& polynomials() const { return value_; }
  const Harmonic& oscillation() const { return harmonic_; }

  /// Where a derivative may jump, ascending [s].
  std::span<const double> breaks() const { return breaks_; }
  /// Step in time that misses nothing of the function [s]; infinite for one that is smooth as a whole.
  double resolution() const { return resolution_; }

 private:
  explicit TimeFunction(PiecewisePolynomial value);

  PiecewisePolynomial value_, rate_, acceleration_;
  Harmonic harmonic_;  // added; none where the amplitude is 0
  std::vector<double> breaks_;
  double resolution_ = std::numeric_limits<double>::infinity();
};

}  // namespace sprung::dynamics
