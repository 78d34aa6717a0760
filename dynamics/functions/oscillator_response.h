#pragma once

#include <array>
#include <span>

namespace sprung::dynamics {

/// The exact solution of x″ + 2d x′ + ω² x = p at one instant, for unit initial values and for forces that
/// are powers of time. The rates of the forced parts follow from dX_k/dt = X_{k−1} (functions, eq. 4).
struct OscillatorResponse {
  static constexpr int kMaxPower = 4;

  double c, c_rate;  ///< x and x′ that follow from x(0) = 1, x′(0) = 0 [1, 1/s]
  double s, s_rate;  ///< x and x′ that follow from x(0) = 0, x′(0) = 1 [s, 1]
  /// x from rest with p = t^k/k!, k = 0…kMaxPower [s^(k+2)]. The rate of entry k is entry k − 1; the rate of
  /// entry 0 is s.
  std::array<double, kMaxPower + 1> forced;

  double forced_rate(int k) const { return k > 0 ? forced[static_cast<std::size_t>(k - 1)] : s; }
};

/// Those of several oscillators at the same time, which takes less than one after the other.
/// @param stiffness  ω² of each [1/s²]; negative where the motion grows
/// @param decay  d of each [1/s]
/// @param time  at least 0 [s]
/// @param max_power  highest k of the forced responses, at most kMaxPower; higher ones are set to zero
/// @param[out] responses  one for each oscillator
void calc_oscillator_responses(std::span<const double> stiffness, std::span<const double> decay, double time,
                               int max_power, std::span<OscillatorResponse> responses);

}  // namespace sprung::dynamics
