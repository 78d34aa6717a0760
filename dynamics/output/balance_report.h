#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/linear/vehicle_modes.h"

namespace sprung::dynamics {

/// A static equilibrium with what it started from.
struct BalanceReport {
  const Model& model;
  const Vehicle& vehicle;
  const Equilibrium& equilibrium;
  const AssemblyReport& assembly;
  bool is_steady = false;          ///< what is carried along is in balance in its motion
  Eigen::VectorXd file_positions;  ///< num_coordinates, as the vehicle file has them
};

/// Positions of the bodies, force elements and what is neutral, as tables for people.
std::string format_equilibrium(const BalanceReport& report);
std::string format_equilibrium_json(const BalanceReport& report);

/// Table of the vehicle's modes.
/// @param is_steady  about steady motion, not at rest
std::string format_modes(const Model& model, const Vehicle& vehicle, const std::vector<VehicleMode>& modes,
                         bool is_steady = false);
std::string format_modes_json(const std::vector<VehicleMode>& modes);

}  // namespace sprung::dynamics
