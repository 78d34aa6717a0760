#pragma once

#include <array>

namespace sprung::dynamics {

/// Motion at one instant of x″ + 2d x′ + ω² x = p from each of its possible causes, exactly.
/// Source: variation of constants; the forced parts by dX_k/dt = X_{k−1} (functions, eq. 2).
struct OscillatorResponse {
  static constexpr int kMaxPower = 4;

  double c, c_rate;  ///< from x = 1, x′ = 0 [1, 1/s]
  double s, s_rate;  ///< from x = 0, x′ = 1 [s, 1]
  /// From rest under p = t^k/k!, k = 0…kMaxPower [s^(k+2)]; the rate of the k-th is the (k−1)-th, of the
  /// first s.
  std::array<double, kMaxPower + 1> forced;

  double forced_rate(int k) const { return k > 0 ? forced[static_cast<std::size_t>(k - 1)] : s; }
};

/// @param stiffness  ω² ≥ 0 [1/s²]
/// @param decay  d [1/s]
/// @param time  at least 0 [s]
/// @param max_power  of the forced responses that are wanted, at most kMaxPower; higher ones stay zero
OscillatorResponse calc_oscillator_response(double stiffness, double decay, double time,
                                            int max_power = OscillatorResponse::kMaxPower);

}  // namespace sprung::dynamics
