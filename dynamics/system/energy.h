#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

/// Kinetic and stored energy [J].                                                        (system, eq. 8)
struct Energy {
  double kinetic = 0.0;
  double strain = 0.0;   ///< of the modes
  double gravity = 0.0;  ///< potential, zero at the world's origin
  double spring = 0.0;   ///< stored in force elements
  double total() const { return kinetic + strain + gravity + spring; }
};

/// @param terms     positions, mass and velocities up to date
/// @param branches  num_branches
Energy calc_energy(const SystemTerms& terms, std::span<const int> branches);

/// Parts of the kinetic energy, which joints and forces exchange: of the common centre of mass along x and y,
/// then of each body that of its centre of mass against the common one along x and y, and the rest, of its
/// rotation and deformation. Their sum is the kinetic energy of all bodies, by König's theorem [J].
/// @param terms  mass and velocities up to date   @param[out] parts  2 + 3 · number of bodies
/// Checked by tests/dynamics/system/truck_equations_test.cpp
void calc_kinetic_parts(const SystemTerms& terms, Eigen::VectorXd& parts);

}  // namespace sprung::dynamics
