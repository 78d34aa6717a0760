#pragma once

#include <limits>
#include <span>
#include <vector>

#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A function of time with its first two derivatives: applied forces, prescribed motion (functions, eq. 1).
/// It is smooth between its breaks; at a break, the formula after it holds. The integrator steps to each
/// break exactly and restarts there.
class TimeFunction {
 public:
  TimeFunction() = default;
  /// A constant.
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

  /// Straight lines through points, constant before the first and after the last; each point is a break.
  /// @param t ascending, at least 2 [s]; x as many
  /// @throws std::invalid_argument
  static TimeFunction lines(std::span<const double> t, std::span<const double> x);
  /// Cubic spline through points, twice continuously differentiable, with zero slope at both ends and
  /// constant outside.
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

  /// The function is the sum of these two; with an amplitude of 0 there is no harmonic part.
  const PiecewisePolynomial& polynomials() const { return value_; }
  const Harmonic& oscillation() const { return harmonic_; }

  /// Times at which a derivative may jump, ascending [s].
  std::span<const double> breaks() const { return breaks_; }
  /// Longest step in time that does not step over a detail of the function [s]; infinite without details.
  double resolution() const { return resolution_; }

 private:
  explicit TimeFunction(PiecewisePolynomial value);

  PiecewisePolynomial value_, rate_, acceleration_;
  Harmonic harmonic_;  // added; amplitude 0 if there is none
  std::vector<double> breaks_;
  double resolution_ = std::numeric_limits<double>::infinity();
};

}  // namespace sprung::dynamics
