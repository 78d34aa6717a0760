#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/linear/steady_motion.h"
#include "dynamics/system/partitioned_equations.h"

namespace sprung::dynamics {

/// Longest step of the differences by position, of each coordinate's natural size. The error of the
/// extrapolated difference is of the order of step⁴, its rounding of 1e-16/step.
inline constexpr double kPositionStep = 1e-4;

/// What a function of the state needs beside positions and velocities: accelerations come with the forces.
enum class Needed { kForces, kAccelerations };

/// Computes p values from the state that the equations were evaluated at.
using StateFunction =
    std::function<Eigen::VectorXd(const PartitionedEquations& equations, std::span<const int> branches)>;

/// Derivative with respect to the f independent positions.
struct PositionDerivative {
  Eigen::MatrixXd value;  ///< p×f
  Eigen::VectorXd steps;  ///< f, of the differences, in natural sizes: at most kPositionStep
};
/// Of a function of the state, about rest, by central differences extrapolated to fourth order. Their steps
/// are so short that the laws of force elements that hold at rest hold throughout, but for kinks at rest,
/// which count with the mean of their slopes (linear, "Linearisation"). The equations are left at the last
/// point evaluated.
/// @param q_independent  f
/// @param motion         rest means rest relative to this motion
/// @param[out] spread    p×f, ≥ 0: how far the slopes within the differences lie apart, by kinks and by
///                       strong curvature (linear, eq. 12); may be null
/// @throws support::NumericalError where the constraints cannot be satisfied around q_independent
PositionDerivative differentiate_by_position(PartitionedEquations& equations, double time,
                                             const Eigen::VectorXd& q_independent,
                                             const StateFunction& function, const SteadyMotion& motion = {},
                                             Needed needed = Needed::kAccelerations,
                                             Eigen::MatrixXd* spread = nullptr);

/// Likewise with respect to the independent velocities, extrapolated so that a law with |v| v has no slope at
/// rest, at the positions that the equations were last evaluated at.
/// @return p×f
Eigen::MatrixXd differentiate_by_velocity(PartitionedEquations& equations, const StateFunction& function,
                                          const SteadyMotion& motion = {},
                                          Needed needed = Needed::kAccelerations);

/// A force element whose law has two slopes at rest, or within kPositionStep of it.
struct Kink {
  std::string element;      ///< its name
  bool in_position = true;  ///< false if a damper's slope changes with the sign of a velocity
  bool is_at_rest = true;   ///< false for one in position beside it

  /// Of one in position, for the user.
  std::string describe() const;
};
/// The kinks about rest at given positions: each element at most once in position and once in velocity,
/// positions first. In velocity the slopes of its channels have to differ.
/// @param motion  rest means rest relative to this motion
std::vector<Kink> find_kinks(PartitionedEquations& equations, double time,
                             const Eigen::VectorXd& q_independent, const SteadyMotion& motion = {});

}  // namespace sprung::dynamics
