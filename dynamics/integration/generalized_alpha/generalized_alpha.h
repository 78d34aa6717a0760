#pragma once

namespace sprung::dynamics {

/// The coefficients of the generalized-α method (integration/generalized_alpha, eqs. 1, 2): second order
/// whatever the spectral radius ρ at infinite frequency, least damping below it. Source: [Chung & Hulbert
/// 1993]
struct GeneralizedAlpha {
  double alpha_m = 0.0, alpha_f = 0.0, beta = 0.0, gamma = 0.0;

  /// @param spectral_radius  0 (a mode of infinite frequency is gone after a step) to 1 (it stays)
  /// @throws std::invalid_argument outside 0 … 1
  explicit GeneralizedAlpha(double spectral_radius);

  /// The auxiliary acceleration a stands for q̈ that many steps ahead: αm − αf.
  double offset() const { return alpha_m - alpha_f; }
  /// Errors of a step: h³ q⃛ times the first in q, h³ q⁗ times the second in v
  /// (integration/generalized_alpha, eq. 5).
  double position_error() const;
  double velocity_error() const;
};

}  // namespace sprung::dynamics
