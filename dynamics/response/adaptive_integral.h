#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace sprung::dynamics {

/// Result of an adaptive integration.
struct AdaptiveIntegral {
  Eigen::VectorXd value;  ///< p integrals
  bool converged = true;
  double worst = 0.0;  ///< a point where it did not converge
};

/// Integrals of p functions at once, none of them negative, over panels that are halved until the 7- and the
/// 15-point rule agree for each function.
/// @param breaks     ends of the first panels, ascending, at least 2
/// @param tolerance  error allowed in one panel, as a fraction of each function's integral
/// @param floors     p absolute errors, from the integrals, below which an error is always allowed
/// @throws std::invalid_argument for fewer than 2 breaks
/// Source: [Piessens 1983], rule QK15 — checked by tests/dynamics/response/adaptive_integral_test.cpp
AdaptiveIntegral integrate(const std::function<Eigen::VectorXd(double)>& function,
                           const std::vector<double>& breaks, double tolerance,
                           const std::function<Eigen::VectorXd(const Eigen::VectorXd& values)>& floors);

}  // namespace sprung::dynamics
