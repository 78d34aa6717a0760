#pragma once

#include <string>

#include "dynamics/input/vehicle.h"
#include "dynamics/linear/vehicle_modes.h"

namespace sprung::dynamics {

/// Who moves in a mode, and how, in words: "chassis bending, 95 %; cab pitch, 5 %". A flexible body bends or
/// stretches, by where the nodes of its main mode move more, across the body or along it. A body that moves
/// as a whole has a heave, fore-aft motion or pitch, named from a quarter of its energy on; with a wheel on
/// it, it hops and turns. Percentages are shares of the kinetic energy. Checked by
/// tests/dynamics/truck_balance_test.cpp
std::string describe_moving_bodies(const Model& model, const Vehicle& vehicle, const VehicleMode& mode);

}  // namespace sprung::dynamics
