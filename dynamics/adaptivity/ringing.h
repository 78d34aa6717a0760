#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/integration/ode_system.h"

namespace sprung::dynamics {

/// The vibration that remains after the forces on a system have changed: accelerations of points with the
/// undamped modes (ω_i, φ_i) of small motion, as shares of a reference for each point. Shares of several
/// vibrations add up to the root of the sum of their squares (adaptivity, eqs. 4, 6). f independent
/// coordinates.
class Ringing {
 public:
  /// A point whose acceleration counts.
  struct Point {
    Eigen::Matrix2Xd motion;    ///< ∂r/∂q_i, 2×f
    double acceleration = 0.0;  ///< the reference of shares, > 0 [m/s²]
  };

  /// @throws support::NumericalError if there are no undamped modes: M is not positive definite
  Ringing(const SmallMotion& motion, const std::vector<Point>& points);

  /// After an impulse p on the independent coordinates: ω_i φ_iᵀp. @return the largest share of any point
  double calc_share_of_impulse(const Eigen::VectorXd& impulse) const;
  /// After a constant force F has faded, F (1 + cos πt/T)/2:
  ///     φ_iᵀF |cos(ω_iT/2)| / |1 − x²| ≤ φ_iᵀF / max(1, x² − 1),   x = ω_iT/π
  /// @param time  T [s], 0: at once   @return the largest share of any point, by that bound
  double calc_share_of_release(const Eigen::VectorXd& force, double time) const;
  /// The shortest T after which no larger share remains, to 1 %; at most `longest`, and 0 where the force may
  /// stop at once.
  /// @param longest  > 0, also the result without points [s]
  double calc_release_time(const Eigen::VectorXd& force, double share, double longest) const;

 private:
  double calc_share(const Eigen::ArrayXd& accelerations) const;

  Eigen::ArrayXd omega_;   // [rad/s]
  Eigen::MatrixXd Phi_;    // f×f
  Eigen::ArrayXXd reach_;  // acceleration of each point per unit of each vibration's, over its reference
};

}  // namespace sprung::dynamics
