#include "dynamics/integration/generalized_alpha/generalized_alpha.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::dynamics {

GeneralizedAlpha::GeneralizedAlpha(double spectral_radius) {
  if (!(spectral_radius >= 0.0 && spectral_radius <= 1.0)) {
    throw std::invalid_argument(
        fmt::format("GeneralizedAlpha: spectral_radius must be 0 to 1, got {}", spectral_radius));
  }
  alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
  alpha_f = spectral_radius / (spectral_radius + 1.0);
  gamma = 0.5 - offset();
  beta = 0.25 * std::pow(gamma + 0.5, 2);
}

double GeneralizedAlpha::position_error() const {
  return beta + 0.5 * offset() - 1.0 / 6.0;
}

double GeneralizedAlpha::velocity_error() const {
  const double of_auxiliary = alpha_f * (1.0 - alpha_f) - alpha_m * (1.0 - alpha_m);
  return 0.5 * (gamma * (1.0 - gamma) + of_auxiliary) - 1.0 / 24.0;
}

}  // namespace sprung::dynamics
