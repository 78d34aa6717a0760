#pragma once

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

}  // namespace sprung::dynamics
