#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/functions/detail_lengths.h"
#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// A function of time with its first two derivatives: applied forces, prescribed motion (functions, eqs.
/// 1, 2). It is smooth between its breaks; at a break, the formula after it holds. The integrator steps to
/// each break exactly and restarts there.
/// Checked by tests/dynamics/functions/time_function_test.cpp, time_function_sums_test.cpp
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

  /// Straight lines through points, constant before the first and after the last; each point is a break. At
  /// two points of equal time the function jumps.
  /// @param t  at least 2, none smaller than the one before, no three equal [s]; x as many
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

  static TimeFunction sum(const TimeFunction& a, const TimeFunction& b);
  /// The product of two oscillations is the sum of two, with sum and difference of the frequencies.
  static TimeFunction product(const TimeFunction& a, const TimeFunction& b);
  /// parts[k] between ends[k − 1] and ends[k]; parts[0] before ends[0], the last part after the last end.
  /// @param ends  ascending, at least 1 [s]   @param parts  one more than ends
  /// @throws std::invalid_argument
  static TimeFunction pieces(std::span<const double> ends, std::span<const TimeFunction> parts);

  double value(double time) const;
  double rate(double time) const;
  double acceleration(double time) const;
  bool is_constant() const;

  /// amplitude(t) sin(2π frequency t + phase)
  struct Oscillation {
    PiecewisePolynomial amplitude;
    double frequency_hz = 0.0;  ///< > 0
    double phase = 0.0;         ///< [rad]
  };
  /// The function is the sum of its polynomials and its oscillations.
  const PiecewisePolynomial& polynomials() const { return value_; }
  std::span<const Oscillation> oscillations() const { return oscillations_; }

  /// Times at which the function or a derivative may jump, ascending [s].
  std::span<const double> breaks() const { return breaks_; }
  /// How long its details are: an eighth of a period, the distance of two points of a spline.
  const DetailLengths& details() const { return details_; }

  struct Jump {
    double time = 0.0;                 ///< [s]
    double before = 0.0, after = 0.0;  ///< of the value, or of the rate
    bool is_rate = false;
  };
  /// The first break at which the value or the rate jumps by more than rounding: by 1e-9 of its size.
  std::optional<Jump> find_jump() const;

 private:
  explicit TimeFunction(PiecewisePolynomial value);
  // Adds it unless its amplitude is 0; without a frequency, it is added to the polynomials.
  void add_oscillation(const Oscillation& oscillation);
  // Adds ½ a b cos(2π frequency t + phase); the frequency may be negative or 0.
  void add_cosine(const PiecewisePolynomial& a, const PiecewisePolynomial& b, double frequency_hz,
                  double phase);

  PiecewisePolynomial value_;
  std::vector<Oscillation> oscillations_;
  std::vector<double> breaks_;
  DetailLengths details_;
};

}  // namespace sprung::dynamics
