#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/integration/ode_system.h"

namespace sprung::dynamics {

/// What is left ringing where the forces on a system change: accelerations of watched points with the
/// undamped vibrations (ω_i, φ_i) of small motion, as shares of a size that each point has; those of the
/// vibrations add up to the root of the sum of their squares (adaptivity, eqs. 4, 6). f independents.
class Ringing {
 public:
  /// A point that is watched.
  struct Point {
    Eigen::Matrix2Xd motion;    ///< ∂r/∂q_i, 2×f
    double acceleration = 0.0;  ///< that shares refer to, > 0 [m/s²]
  };

  /// @throws support::NumericalError if there are no undamped modes: M is not positive definite
  Ringing(const SmallMotion& motion, const std::vector<Point>& points);

  /// By an impulse on the independents: ω_i φ_iᵀp. @return the largest share of any point
  double calc_share_of_impulse(const Eigen::VectorXd& impulse) const;
  /// By a force F that stood still and is let go, F (1 + cos πt/T)/2:
  ///     φ_iᵀF |cos(ω_iT/2)| / |1 − x²| ≤ φ_iᵀF / max(1, x² − 1),   x = ω_iT/π
  /// @param time  T [s], 0: at once   @return the largest share of any point, by that bound
  double calc_share_of_release(const Eigen::VectorXd& force, double time) const;
  /// The shortest T that leaves no larger share, to 1 %: at most `longest`, 0 where letting go at once is
  /// good enough.
  /// @param longest  > 0 [s]; also where no point is watched
  double calc_release_time(const Eigen::VectorXd& force, double share, double longest) const;

 private:
  double calc_share(const Eigen::ArrayXd& accelerations) const;

  Eigen::ArrayXd omega_;  // [rad/s]
  Eigen::MatrixXd Phi_;   // f×f
  Eigen::ArrayXXd
      reach_;  // acceleration of each point per unit of each vibration's, of what its shares refer to
};

}  // namespace sprung::dynamics
