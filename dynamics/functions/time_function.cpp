#include "dynamics/functions/time_function.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "dynamics/functions/piecewise_arithmetic.h"

namespace sprung::dynamics {

namespace {

// A jump that counts as rounding, of the size of the function or of its rate.
constexpr double kRoundingJump = 1e-9;
constexpr int kSamples = 8;  // between two breaks, for that size

double angular_frequency(double frequency_hz) {
  return 2.0 * std::numbers::pi * frequency_hz;
}

// An eighth of a period.
DetailLengths find_details(double frequency_hz) {
  return DetailLengths(0.125 / frequency_hz);
}

// Ascending, each once.
std::vector<double> merge_times(std::span<const double> a, std::span<const double> b) {
  std::vector<double> merged;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(merged));
  return merged;
}

// The points of a table by time; two points of equal time belong to one break.
void check_times(std::span<const double> t, std::span<const double> x) {
  if (t.size() < 2 || t.size() != x.size()) {
    throw std::invalid_argument(
        fmt::format("TimeFunction::lines: needs at least 2 points and as many values as times, got {} and {}",
                    t.size(), x.size()));
  }
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (!(t[i] >= t[i - 1]) || (i > 1 && t[i] == t[i - 2])) {
      throw std::invalid_argument(
          fmt::format("TimeFunction::lines: times must ascend, and no three be equal, got {} s after {} s",
                      t[i], t[i - 1]));
    }
  }
}

}  // namespace

TimeFunction::TimeFunction(PiecewisePolynomial value) : value_(std::move(value)) {}

TimeFunction TimeFunction::polynomial(std::vector<double> coefficients) {
  return TimeFunction(PiecewisePolynomial(std::move(coefficients)));
}

TimeFunction TimeFunction::harmonic(const Harmonic& parameters) {
  if (!(parameters.frequency_hz > 0.0)) {
    throw std::invalid_argument(
        fmt::format("TimeFunction::harmonic: frequency_hz must be > 0 Hz, got {}", parameters.frequency_hz));
  }
  TimeFunction f(parameters.mean);
  f.add_oscillation({.amplitude = PiecewisePolynomial({parameters.amplitude}),
                     .frequency_hz = parameters.frequency_hz,
                     .phase = parameters.phase});
  if (!f.oscillations_.empty()) f.details_ = find_details(parameters.frequency_hz);
  return f;
}

TimeFunction TimeFunction::lines(std::span<const double> t, std::span<const double> x) {
  check_times(t, x);
  std::vector<double> breaks;
  std::vector<std::vector<double>> pieces{{x.front()}};
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (i + 1 < t.size() && t[i + 1] == t[i]) continue;  // a jump: the point after it begins the next line
    breaks.push_back(t[i]);
    if (i + 1 < t.size()) {
      pieces.push_back({x[i], (x[i + 1] - x[i]) / (t[i + 1] - t[i])});
    } else {
      pieces.push_back({x[i]});
    }
  }
  TimeFunction f(PiecewisePolynomial::from_pieces(breaks, std::move(pieces)));
  f.breaks_ = std::move(breaks);
  return f;
}

TimeFunction TimeFunction::spline(std::span<const double> t, std::span<const double> x) {
  PiecewisePolynomial value = PiecewisePolynomial::clamped_spline(t, x);
  value.continue_straight(t.front(), 0.0, true);
  value.continue_straight(t.back(), 0.0, false);
  TimeFunction f(std::move(value));
  f.breaks_ = {t.front(), t.back()};
  f.details_ = DetailLengths::between(t);
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

TimeFunction TimeFunction::sum(const TimeFunction& a, const TimeFunction& b) {
  TimeFunction f(calc_sum(a.value_, b.value_));
  f.breaks_ = merge_times(a.breaks_, b.breaks_);
  f.details_ = DetailLengths::shorter(a.details_, b.details_);
  for (const Oscillation& one : a.oscillations_) f.add_oscillation(one);
  for (const Oscillation& one : b.oscillations_) f.add_oscillation(one);
  return f;
}

TimeFunction TimeFunction::product(const TimeFunction& a, const TimeFunction& b) {
  TimeFunction f(calc_product(a.value_, b.value_));
  f.breaks_ = merge_times(a.breaks_, b.breaks_);
  f.details_ = DetailLengths::shorter(a.details_, b.details_);
  const auto scale = [&](const Oscillation& one, const PiecewisePolynomial& factor) {
    f.add_oscillation({calc_product(one.amplitude, factor), one.frequency_hz, one.phase});
  };
  for (const Oscillation& one : a.oscillations_) scale(one, b.value_);
  for (const Oscillation& one : b.oscillations_) scale(one, a.value_);
  for (const Oscillation& one : a.oscillations_) {
    for (const Oscillation& other : b.oscillations_) {
      // sin x sin y = ½ cos(x − y) − ½ cos(x + y)
      f.add_cosine(one.amplitude, other.amplitude, one.frequency_hz - other.frequency_hz,
                   one.phase - other.phase);
      f.add_cosine(one.amplitude, other.amplitude, one.frequency_hz + other.frequency_hz,
                   one.phase + other.phase + std::numbers::pi);
    }
  }
  return f;
}

TimeFunction TimeFunction::pieces(std::span<const double> ends, std::span<const TimeFunction> parts) {
  std::vector<PiecewisePolynomial> cut;
  for (const TimeFunction& part : parts) cut.push_back(part.value_);
  TimeFunction f(join_parts(ends, cut));
  std::vector<double> inside;
  std::vector<DetailLengths> details;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const double from = k == 0 ? -std::numeric_limits<double>::infinity() : ends[k - 1];
    const double to = k == ends.size() ? std::numeric_limits<double>::infinity() : ends[k];
    std::copy_if(parts[k].breaks_.begin(), parts[k].breaks_.end(), std::back_inserter(inside),
                 [&](double at) { return at > from && at < to; });
    details.push_back(parts[k].details_);
    std::fill(cut.begin(), cut.end(), PiecewisePolynomial());
    for (const Oscillation& one : parts[k].oscillations_) {
      cut[k] = one.amplitude;
      f.add_oscillation({join_parts(ends, cut), one.frequency_hz, one.phase});
    }
  }
  f.breaks_ = merge_times(ends, inside);
  f.details_ = DetailLengths::join(ends, details);
  return f;
}

void TimeFunction::add_oscillation(const Oscillation& oscillation) {
  if (!oscillation.amplitude.is_zero()) oscillations_.push_back(oscillation);
}

void TimeFunction::add_cosine(const PiecewisePolynomial& a, const PiecewisePolynomial& b, double frequency_hz,
                              double phase) {
  const PiecewisePolynomial amplitude = calc_product(calc_product(a, b), PiecewisePolynomial({0.5}));
  if (frequency_hz == 0.0) {
    value_ = calc_sum(value_, calc_product(amplitude, PiecewisePolynomial({std::cos(phase)})));
    return;
  }
  const double direction = frequency_hz > 0.0 ? 1.0 : -1.0;  // cos(−x) = cos x
  if (!amplitude.is_zero())
    details_ = DetailLengths::shorter(details_, find_details(direction * frequency_hz));
  add_oscillation({amplitude, direction * frequency_hz, direction * phase + 0.5 * std::numbers::pi});
}

double TimeFunction::value(double time) const {
  double x = value_.value(time);
  for (const Oscillation& one : oscillations_) {
    const double amplitude = one.amplitude.value(time);
    if (amplitude == 0.0) continue;
    x += amplitude * std::sin(angular_frequency(one.frequency_hz) * time + one.phase);
  }
  return x;
}

double TimeFunction::rate(double time) const {
  double x = value_.slope(time);
  for (const Oscillation& one : oscillations_) {
    const double omega = angular_frequency(one.frequency_hz);
    const double angle = omega * time + one.phase;
    const double growth = one.amplitude.slope(time);
    x += one.amplitude.value(time) * omega * std::cos(angle);
    if (growth != 0.0) x += growth * std::sin(angle);
  }
  return x;
}

double TimeFunction::acceleration(double time) const {
  double x = value_.curvature(time);
  for (const Oscillation& one : oscillations_) {
    const double omega = angular_frequency(one.frequency_hz);
    const double angle = omega * time + one.phase;
    const double growth = one.amplitude.slope(time);
    const double change = one.amplitude.curvature(time);
    x -= one.amplitude.value(time) * omega * omega * std::sin(angle);
    if (growth != 0.0) x += 2.0 * growth * omega * std::cos(angle);
    if (change != 0.0) x += change * std::sin(angle);
  }
  return x;
}

bool TimeFunction::is_constant() const {
  return oscillations_.empty() && value_.is_constant();
}

std::optional<TimeFunction::Jump> TimeFunction::find_jump() const {
  double largest_value = 0.0, largest_rate = 0.0;
  for (std::size_t i = 0; i < breaks_.size(); ++i) {
    const double gap =
        i + 1 < breaks_.size() ? breaks_[i + 1] - breaks_[i] : std::min(1.0, 8.0 * details_.shortest());
    const double from = i == 0 ? breaks_[0] - gap : breaks_[i];
    for (int k = 0; k <= 2 * kSamples; ++k) {
      const double time = from + gap * k / kSamples;
      largest_value = std::max(largest_value, std::abs(value(time)));
      largest_rate = std::max(largest_rate, std::abs(rate(time)));
    }
  }
  // A function with a period may be zero at all of these times; a spline has its values at its own breaks.
  for (std::size_t i = 0; i + 1 < value_.breaks().size(); ++i) {
    for (const double share : {0.0, 0.5}) {
      const double time = value_.breaks()[i] + share * (value_.breaks()[i + 1] - value_.breaks()[i]);
      largest_value = std::max(largest_value, std::abs(value(time)));
      largest_rate = std::max(largest_rate, std::abs(rate(time)));
    }
  }
  for (const double time : breaks_) {
    const double just_before = std::nextafter(time, -std::numeric_limits<double>::infinity());
    const Jump values{.time = time, .before = value(just_before), .after = value(time)};
    if (std::abs(values.after - values.before) > kRoundingJump * largest_value) return values;
    const Jump rates{.time = time, .before = rate(just_before), .after = rate(time), .is_rate = true};
    if (std::abs(rates.after - rates.before) > kRoundingJump * largest_rate) return rates;
  }
  return std::nullopt;
}

}  // namespace sprung::dynamics
