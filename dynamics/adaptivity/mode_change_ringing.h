#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/adaptivity/mode_indicator.h"

namespace sprung::dynamics {

/// Time within which the forces that held modes have to fade when these join: after it each point asked for
/// rings by at most a share of its largest acceleration so far (adaptivity, eq. 4).
/// @param indicator    the modes are active in it already
/// @param coordinates  of the modes   @param forces  on them [N/√kg]
/// @param longest      also where that is not enough, or the ringing is not known [s]
double calc_release_time(const ModeIndicator& indicator, const std::vector<int>& coordinates,
                         const std::vector<double>& forces, double share, double longest);

/// Ringing caused by stopping each of some modes, when all of them leave: by an impulse on the rest
/// (adaptivity, eq. 6).
/// @param coordinates  of the modes, active in the indicator   @param v  in coordinates of the full model
/// @return largest share of any asked point's largest acceleration so far, for each of the modes
std::vector<double> calc_stopping_shares(const ModeIndicator& indicator, const std::vector<int>& coordinates,
                                         const Eigen::VectorXd& v);

}  // namespace sprung::dynamics
