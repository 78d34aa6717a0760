#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/analysis/ode_system.h"

namespace sprung::dynamics {

/// A point that is watched while forces are let go.
struct ReleasedPoint {
  Eigen::Matrix2Xd motion;            ///< ∂r/∂q_i, 2×f
  double allowed_acceleration = 0.0;  ///< that may be left ringing, > 0 [m/s²]
};

/// Time T over which forces F (1 + cos πt/T)/2 have to be let go, so that they leave no more ringing behind than is
/// allowed. Of the vibrations (ω_i, φ_i) of small motion, undamped, each is left with the acceleration
///     φ_iᵀF |cos(ω_iT/2)| / |1 − x²| ≤ φ_iᵀF / max(1, x² − 1),   x = ω_iT/π          (dynamics/README.md, eq. 75)
/// and at a point they add up to the root of the sum of their squares. Exact to 1 % of T.
/// @param motion   in f independents, forces still held acting
/// @param force    F, f
/// @param points   none: nothing is known about what matters, and T is the longest
/// @param longest  > 0 [s]
/// @return at most `longest`; 0 where letting go at once is good enough
/// @throws support::NumericalError if there are no undamped modes: M is not positive definite
double calc_release_time(const SmallMotion& motion, const Eigen::VectorXd& force,
                         const std::vector<ReleasedPoint>& points, double longest);

}  // namespace sprung::dynamics
