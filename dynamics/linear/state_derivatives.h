#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/linear/steady_motion.h"
#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// Step of the differences by position, of each coordinate's natural size. The error of the extrapolated
/// difference is of the order of step⁴, its rounding of 1e-16/step.
inline constexpr double kPositionStep = 1e-4;

/// p values made of the state that the equations were evaluated at, positions to accelerations.
using StateFunction =
    std::function<Eigen::VectorXd(const PartitionedEquations& equations, std::span<const int> branches)>;

/// Derivatives of a function of the state with respect to the independent positions, about rest: central
/// differences extrapolated to fourth order, branches chosen at each point, so that a kink counts with the
/// mean of its slopes. The equations are left at the last point compared.
/// @param q_independent  f, that the constraints can be satisfied around
/// @param motion  rest is that of what it carries along
/// @return p×f
/// @throws support::NumericalError where they cannot
Eigen::MatrixXd differentiate_by_position(PartitionedEquations& equations, double time,
                                          const Eigen::VectorXd& q_independent, const StateFunction& function,
                                          const SteadyMotion& motion = {});

/// Likewise with respect to the independent velocities, about rest at the positions evaluated last.
/// @return p×f
Eigen::MatrixXd differentiate_by_velocity(PartitionedEquations& equations, const StateFunction& function,
                                          const SteadyMotion& motion = {});

/// A force element that goes over to another of its formulas within the differences above.
struct Kink {
  std::string element;      ///< its name
  bool in_position = true;  ///< false: as the velocities pass through rest
};
/// The kinks about rest at given positions, each element once for each of its kinds, positions first.
std::vector<Kink> find_kinks(PartitionedEquations& equations, double time,
                             const Eigen::VectorXd& q_independent);

}  // namespace sprung::dynamics
