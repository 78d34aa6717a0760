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

/// What a function of the state needs beside positions and velocities: accelerations come with the forces.
enum class Needed { kForces, kAccelerations };

/// Computes p values from the state that the equations were evaluated at.
using StateFunction =
    std::function<Eigen::VectorXd(const PartitionedEquations& equations, std::span<const int> branches)>;

/// Derivatives of a function of the state with respect to the independent positions, about rest, by central
/// differences extrapolated to fourth order. Branches are chosen at each point, so that a kink counts with
/// the mean of its slopes. The equations are left at the last point evaluated.
/// @param q_independent  f
/// @param motion         rest means rest relative to this motion
/// @param[out] spread    p×f, ≥ 0: how far the slopes within the differences lie apart, by kinks and by
///                       strong curvature (linear, eq. 12); may be null
/// @return p×f
/// @throws support::NumericalError where the constraints cannot be satisfied around q_independent
Eigen::MatrixXd differentiate_by_position(PartitionedEquations& equations, double time,
                                          const Eigen::VectorXd& q_independent, const StateFunction& function,
                                          const SteadyMotion& motion = {},
                                          Needed needed = Needed::kAccelerations,
                                          Eigen::MatrixXd* spread = nullptr);

/// Likewise with respect to the independent velocities, by central differences about rest, extrapolated so
/// that a law with |v| v has no slope at rest, at the positions that the equations were last evaluated at.
/// @return p×f
Eigen::MatrixXd differentiate_by_velocity(PartitionedEquations& equations, const StateFunction& function,
                                          const SteadyMotion& motion = {},
                                          Needed needed = Needed::kAccelerations);

/// A force element whose law has two slopes within the differences above.
struct Kink {
  std::string element;      ///< its name
  bool in_position = true;  ///< false if a damper's slope changes with the sign of a velocity

  /// Of one in position, for the user.
  std::string describe() const;
};
/// The kinks about rest at given positions: each element at most once in position and once in velocity,
/// positions first. In velocity the slopes of its channels have to differ.
/// @param motion  rest means rest relative to this motion
std::vector<Kink> find_kinks(PartitionedEquations& equations, double time,
                             const Eigen::VectorXd& q_independent, const SteadyMotion& motion = {});

}  // namespace sprung::dynamics
