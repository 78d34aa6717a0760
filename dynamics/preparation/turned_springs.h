#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The force elements along a line whose ends have changed sides from one position of the vehicle to another:
/// the direction from a to b has turned by more than 90°, seen from either body. A spring that is too soft
/// for its load, and meets no stop, shortens to nothing and then grows again on the other side: a position in
/// equilibrium that no vehicle has.
/// @param drawn, found  coordinates
/// @return their places in vehicle.forces
/// Checked by tests/dynamics/program/unlikely_balance_test.py
std::vector<std::size_t> find_turned_springs(const Vehicle& vehicle, const Model& model,
                                             const Eigen::VectorXd& drawn, const Eigen::VectorXd& found);

}  // namespace sprung::dynamics
