#include "dynamics/functions/time_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

double angular_frequency(const TimeFunction::Harmonic& harmonic) {
  return 2.0 * std::numbers::pi * harmonic.frequency_hz;
}

}  // namespace

TimeFunction::TimeFunction(PiecewisePolynomial value)
    : value_(std::move(value)), rate_(value_.derivative()), acceleration_(rate_.derivative()) {}

TimeFunction TimeFunction::polynomial(std::vector<double> coefficients) {
  return TimeFunction(PiecewisePolynomial(std::move(coefficients)));
}

TimeFunction TimeFunction::harmonic(const Harmonic& parameters) {
  if (!(parameters.frequency_hz > 0.0)) {
    throw std::invalid_argument(
        fmt::format("TimeFunction::harmonic: frequency_hz must be > 0 Hz, got {}", parameters.frequency_hz));
  }
  TimeFunction f(parameters.mean);
  f.harmonic_ = parameters;
  f.resolution_ = 0.125 / parameters.frequency_hz;
  return f;
}

TimeFunction TimeFunction::lines(std::span<const double> t, std::span<const double> x) {
  PiecewisePolynomial value = PiecewisePolynomial::through_points(t, x);
  value.continue_straight(t.front(), 0.0, true);
  value.continue_straight(t.back(), 0.0, false);
  TimeFunction f(std::move(value));
  f.breaks_.assign(t.begin(), t.end());
  return f;
}

TimeFunction TimeFunction::spline(std::span<const double> t, std::span<const double> x) {
  PiecewisePolynomial value = PiecewisePolynomial::clamped_spline(t, x);
  value.continue_straight(t.front(), 0.0, true);
  value.continue_straight(t.back(), 0.0, false);
  TimeFunction f(std::move(value));
  f.breaks_ = {t.front(), t.back()};
  for (std::size_t i = 1; i < t.size(); ++i) f.resolution_ = std::min(f.resolution_, t[i] - t[i - 1]);
  return f;
}

TimeFunction TimeFunction::smooth_step(const Step& parameters) {
  const double duration = parameters.end - parameters.start;
  if (!(duration > 0.0)) {
    throw std::invalid_argument(
        fmt::format("TimeFunction::smooth_step: end must come after start, got {} s and {} s", parameters.end,
                    parameters.start));
  }
  const double change = parameters.after - parameters.before;
  const double cubed = duration * duration * duration;
  TimeFunction f(PiecewisePolynomial::from_pieces(
      {parameters.start, parameters.end},
      {{parameters.before},
       {parameters.before, 0.0, 0.0, 10.0 * change / cubed, -15.0 * change / (cubed * duration),
        6.0 * change / (cubed * duration * duration)},
       {parameters.after}}));
  f.breaks_ = {parameters.start, parameters.end};
  return f;
}

double TimeFunction::value(double time) const {
  double x = value_.value(time);
  if (harmonic_.amplitude != 0.0) {
    x += harmonic_.amplitude * std::sin(angular_frequency(harmonic_) * time + harmonic_.phase);
  }
  return x;
}

double TimeFunction::rate(double time) const {
  double x = rate_.value(time);
  if (harmonic_.amplitude != 0.0) {
    const double omega = angular_frequency(harmonic_);
    x += harmonic_.amplitude * omega * std::cos(omega * time + harmonic_.phase);
  }
  return x;
}

double TimeFunction::acceleration(double time) const {
  double x = acceleration_.value(time);
  if (harmonic_.amplitude != 0.0) {
    const double omega = angular_frequency(harmonic_);
    x -= harmonic_.amplitude * omega * omega * std::sin(omega * time + harmonic_.phase);
  }
  return x;
}

bool TimeFunction::is_constant() const {
  return harmonic_.amplitude == 0.0 && rate_.is_zero();
}

}  // namespace sprung::dynamics
