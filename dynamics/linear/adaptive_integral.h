#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace sprung::dynamics {

/// Result of an adaptive integration.
struct AdaptiveIntegral {
  Eigen::VectorXd value;  ///< p integrals
  bool converged = true;
  double worst = 0.0;  ///< where it did not converge
};

/// ∫ of p functions at once that are nowhere negative, over panels that are halved until the 7- and the
/// 15-point rule agree for each function.
/// Source: [Piessens 1983], rule QK15
/// @param breaks     ends of the first panels, ascending, at least 2
/// @param tolerance  error allowed in a panel, of each function's integral
/// @param floors     p, error that never matters, or empty: of a function that is zero but for rounding
AdaptiveIntegral integrate(const std::function<Eigen::VectorXd(double)>& function,
                           const std::vector<double>& breaks, double tolerance,
                           const std::function<Eigen::VectorXd(const Eigen::VectorXd& values)>& floors);

}  // namespace sprung::dynamics
