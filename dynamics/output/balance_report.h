#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/linear/vehicle_modes.h"

namespace sprung::dynamics {

/// An equilibrium, and the positions that the search started from.
struct BalanceReport {
  const Model& model;
  const Vehicle& vehicle;
  const Equilibrium& equilibrium;
  const AssemblyReport& assembly;
  bool is_steady = false;          ///< whether it is an equilibrium relative to a steady motion
  Eigen::VectorXd file_positions;  ///< num_coordinates, as given in the vehicle file
};

/// Positions of the bodies, values of the force elements and neutral directions, as text tables.
std::string format_equilibrium(const BalanceReport& report);
/// Positions, values and neutral directions as one JSON object, SI units.
std::string format_equilibrium_json(const BalanceReport& report);

/// Table of the vehicle's modes.
/// @param is_steady  about steady motion, not at rest
std::string format_modes(const Model& model, const Vehicle& vehicle, const std::vector<VehicleMode>& modes,
                         bool is_steady = false);
std::string format_modes_json(const std::vector<VehicleMode>& modes);

}  // namespace sprung::dynamics
