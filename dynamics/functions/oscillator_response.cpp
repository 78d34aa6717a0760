#include "dynamics/functions/oscillator_response.h"

#include <Eigen/Core>
#include <cmath>
#include <iterator>

namespace sprung::dynamics {

namespace {

constexpr int kTop = OscillatorResponse::kMaxPower;
constexpr double kInverseFactorial[] = {1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0};
static_assert(kTop + 2 < static_cast<int>(std::size(kInverseFactorial)));

// Scaled time below which the power series is used; all of its terms are then smaller than the one before.
constexpr double kSeriesLimit = 1.5;
// d/ω above which the two exponentials of an overdamped oscillator have clearly different rates, and below
// which the recurrence divides by no small number.
constexpr double kOverdamped = 1.2;

// 1/m and 1/(m(m−1)).
constexpr int kMaxTerms = 60;
constexpr auto kSeriesDivisors = [] {
  std::array<std::array<double, 2>, kMaxTerms> divisors{};
  for (std::size_t m = 2; m < kMaxTerms; ++m) {
    const auto value = static_cast<double>(m);
    divisors[m] = {1.0 / value, 1.0 / (value * (value - 1.0))};
  }
  return divisors;
}();

double sinhc(double x) {
  return std::abs(x) < 1e-4 ? 1.0 + x * x / 6.0 : std::sinh(x) / x;
}

double power_term(int k, double time) {
  double value = kInverseFactorial[k];
  for (int i = 0; i < k; ++i) value *= time;
  return value;
}

// Oscillators whose series are summed at the same time: each term of a series waits for the one before.
constexpr std::size_t kLanes = 4;
using Lanes = Eigen::Array<double, kLanes, 1>;

// The highest two forced responses by their power series, the lower ones by the differential equation, which
// needs products only.
std::array<OscillatorResponse, kLanes> by_series(const Lanes& stiffness, const Lanes& decay, double time,
                                                 int top) {
  // X_top = Σ b_m t^m, m(m−1) b_m = −2d (m−1) b_{m−1} − ω² b_{m−2}; a term is b_m t^m.
  Lanes before = Lanes::Zero(), term = Lanes::Constant(power_term(top + 2, time));
  Lanes value = term, rate = (top + 2) * term;
  const Lanes damping = -2.0 * time * decay, spring = -time * time * stiffness;
  for (int m = top + 3; m < kMaxTerms; ++m) {
    const auto& [once, twice] = kSeriesDivisors[static_cast<std::size_t>(m)];
    const Lanes next = once * damping * term + twice * spring * before;
    before = term;
    term = next;
    value += term;
    rate += m * term;
    if ((term.abs() + before.abs() < 1e-18 * value.abs()).all()) break;
  }
  std::array<Lanes, kTop + 3> X;  // X_{−2} … X_top
  X[static_cast<std::size_t>(top) + 2] = value;
  X[static_cast<std::size_t>(top) + 1] = rate / time;
  for (int k = top; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    X[i] = power_term(k, time) - 2.0 * decay * X[i + 1] - stiffness * X[i + 2];
  }
  std::array<OscillatorResponse, kLanes> responses{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    OscillatorResponse& r = responses[lane];
    const auto j = static_cast<Eigen::Index>(lane);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(top); ++k) r.forced[k] = X[k + 2][j];
    r.s = X[1][j];
    r.s_rate = X[0][j];
  }
  return responses;
}

OscillatorResponse by_recurrence(double stiffness, double decay, double time, int top) {
  OscillatorResponse r{};
  const double discriminant = stiffness - decay * decay;
  const double mu = std::sqrt(std::abs(discriminant));
  const double envelope = std::exp(-decay * time);
  if (discriminant >= 0.0) {
    const double angle = mu * time, sine = std::sin(angle), cosine = std::cos(angle);  // found together
    r.s = envelope * time * (angle < 1e-4 ? 1.0 - angle * angle / 6.0 : sine / angle);
    r.s_rate = envelope * cosine - decay * r.s;
  } else if (mu * time < 1.0) {
    r.s = envelope * time * sinhc(mu * time);
    r.s_rate = envelope * std::cosh(mu * time) - decay * r.s;
  } else {
    const double slow = std::exp((mu - decay) * time), fast = std::exp(-(mu + decay) * time);
    r.s = (slow - fast) / (2.0 * mu);
    r.s_rate = 0.5 * (slow + fast) - decay * r.s;
  }
  double last = r.s_rate, current = r.s;
  const double flexibility = 1.0 / stiffness;
  for (int k = 0; k <= top; ++k) {
    const double next = flexibility * (power_term(k, time) - 2.0 * decay * current - last);
    r.forced[static_cast<std::size_t>(k)] = next;
    last = current;
    current = next;
  }
  return r;
}

// ∫ e^{r(t−σ)} σ^k/k! dσ for k = −1 … top, where k = −1 stands for the response to an impulse.
std::array<double, kTop + 2> exponential_responses(double rate, double time, int top) {
  std::array<double, kTop + 2> Y{};
  const double z = rate * time;
  if (std::abs(z) < 1.0) {
    double term = power_term(top + 1, time), sum = term;
    for (int m = top + 2; m < 40; ++m) {
      term *= z / m;
      sum += term;
    }
    Y[static_cast<std::size_t>(top) + 1] = sum;
    for (int k = top; k >= 0; --k) {
      Y[static_cast<std::size_t>(k)] = power_term(k, time) + rate * Y[static_cast<std::size_t>(k) + 1];
    }
  } else {
    Y[0] = std::exp(z);
    for (int k = 0; k <= top; ++k) {
      Y[static_cast<std::size_t>(k) + 1] = (Y[static_cast<std::size_t>(k)] - power_term(k, time)) / rate;
    }
  }
  return Y;
}

// Two exponentials with very different rates: far beyond critical damping, whatever its sign, and with a
// negative stiffness.
OscillatorResponse by_two_rates(double stiffness, double decay, double time, int top) {
  const double root = std::sqrt(decay * decay - stiffness);
  const double large = -(decay + std::copysign(root, decay)), small = stiffness / large;  // the rates
  const auto by_large = exponential_responses(large, time, top);
  const auto by_small = exponential_responses(small, time, top);
  const double difference = small - large;
  OscillatorResponse r{};
  r.s = (by_small[0] - by_large[0]) / difference;
  r.s_rate = (small * by_small[0] - large * by_large[0]) / difference;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(top); ++k)
    r.forced[k] = (by_small[k + 1] - by_large[k + 1]) / difference;
  return r;
}

}  // namespace

void calc_oscillator_responses(std::span<const double> stiffness, std::span<const double> decay, double time,
                               int max_power, std::span<OscillatorResponse> responses) {
  if (time <= 0.0) {
    for (OscillatorResponse& r : responses)
      r = {.c = 1.0, .c_rate = 0.0, .s = 0.0, .s_rate = 1.0, .forced = {}};
    return;
  }
  std::array<std::size_t, kLanes> in_lane{};
  Lanes lane_stiffness, lane_decay;
  std::size_t num_lanes = 0;
  const auto sum_series = [&] {
    for (std::size_t lane = num_lanes; lane < kLanes; ++lane) {  // repeats one where none is left
      lane_stiffness[static_cast<Eigen::Index>(lane)] = lane_stiffness[0];
      lane_decay[static_cast<Eigen::Index>(lane)] = lane_decay[0];
    }
    const auto found = by_series(lane_stiffness, lane_decay, time, max_power);
    for (std::size_t lane = 0; lane < num_lanes; ++lane) responses[in_lane[lane]] = found[lane];
    num_lanes = 0;
  };
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const double omega = std::sqrt(std::abs(stiffness[i]));
    if ((omega + std::abs(decay[i])) * time <= kSeriesLimit) {
      lane_stiffness[static_cast<Eigen::Index>(num_lanes)] = stiffness[i];
      lane_decay[static_cast<Eigen::Index>(num_lanes)] = decay[i];
      in_lane[num_lanes++] = i;
      if (num_lanes == kLanes) sum_series();
      continue;
    }
    const bool has_two_rates = stiffness[i] < 0.0 || std::abs(decay[i]) > kOverdamped * omega;
    responses[i] = has_two_rates ? by_two_rates(stiffness[i], decay[i], time, max_power)
                                 : by_recurrence(stiffness[i], decay[i], time, max_power);
  }
  if (num_lanes > 0) sum_series();
  for (std::size_t i = 0; i < responses.size(); ++i) {
    OscillatorResponse& r = responses[i];
    r.c = r.s_rate + 2.0 * decay[i] * r.s;
    r.c_rate = -stiffness[i] * r.s;
  }
}

}  // namespace sprung::dynamics
