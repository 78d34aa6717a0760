#pragma once

#include <string>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// What was done to satisfy the constraints at the start.
struct AssemblyReport {
  double largest_movement = 0.0;  ///< of any marker [m]
  std::string moved_marker;       ///< which one
  double residual = 0.0;          ///< largest |φ| afterwards
};

/// Moves the bodies from the positions of the input file so that every joint closes, the heavy ones least
/// (Gauss–Newton, least movement in the mass metric).
/// @param[in,out] q  num_coordinates
/// @throws support::InputError at the joint, if the joints cannot be closed from there, or if some of them
///         are redundant (all that take part are named)
AssemblyReport assemble_positions(const Model& model, Eigen::VectorXd& q);

/// What the joints made of the velocities asked for.
struct VelocityReport {
  double largest_change = 0.0;  ///< [natural sizes/s]
  std::string coordinate;       ///< whose it is
};

/// The velocity nearest to v, in the mass metric, that the constraints allow; for prescribed motion it is the
/// one that follows it.
/// @param q  assembled
/// @throws support::NumericalError at a singular position
VelocityReport project_velocities(const Model& model, double time, const Eigen::VectorXd& q,
                                  Eigen::VectorXd& v);

}  // namespace sprung::dynamics
