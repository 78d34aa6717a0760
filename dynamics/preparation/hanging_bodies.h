#pragma once

#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/output/resting_forces.h"

namespace sprung::dynamics {

/// A body that hangs on a spring at rest: nothing else but what it is joined to holds it up.
struct HangingBody {
  std::size_t force = 0;  ///< the spring, of the vehicle's forces
  int body = 0;           ///< that it pulls up
  double pull = 0.0;      ///< > 0 [N]
};

/// Springs whose static length is given and that pull a body up, if only force elements between this body,
/// those that are joined to it below the spring, and the one above act on these: an axle without a tyre.
/// @param at_rest  the equilibrium
/// Checked by tests/dynamics/program/unlikely_balance_test.py
std::vector<HangingBody> find_hanging_bodies(const Vehicle& vehicle, const Model& model,
                                             const RestingForces& at_rest);

}  // namespace sprung::dynamics
