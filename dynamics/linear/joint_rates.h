#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/system/model.h"
#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

/// A rate that the coordinate of a joint is to have at the start.
struct JointRate {
  int joint = 0;                     ///< position in Model::joints; the joint has a coordinate
  double rate = 0.0;                 ///< [m/s, rad/s]
  support::SourceLocation location;  ///< of the rate
};

/// Changes velocities that the joints allow by the least amount, as assemble_positions does positions, so
/// that the joints have the given rates: light bodies change most, and modes not at all unless the joints
/// need them (linear, eq. 10).
/// @param q          assembled positions at t = 0, num_coordinates
/// @param[in,out] v  velocities that satisfy the constraints, num_coordinates
/// @throws support::InputError at the first rate that contradicts the joints, prescribed motion or the rates
///         before it
/// @throws support::NumericalError at a singular position
/// Checked by tests/dynamics/linear/joint_rates_test.cpp
void impose_joint_rates(const Model& model, const Eigen::VectorXd& q, std::span<const JointRate> rates,
                        Eigen::VectorXd& v);

}  // namespace sprung::dynamics
