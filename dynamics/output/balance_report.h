#pragma once

#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/linear/state_derivatives.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/section_loads/resting_sections.h"
#include "dynamics/statistics/run_warnings.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// An equilibrium, and the positions that the search started from.
struct BalanceReport {
  const Model& model;
  const Vehicle& vehicle;
  const Equilibrium& equilibrium;
  const AssemblyReport& assembly;
  bool is_steady = false;                       ///< whether it is an equilibrium relative to a steady motion
  Eigen::VectorXd file_positions;               ///< num_coordinates, as given in the vehicle file
  const SectionStatistics* sections = nullptr;  ///< at the equilibrium; null: not reported
  std::vector<RunWarning> warnings = {};
};

/// What is doubtful at an equilibrium: what the modes miss of moments and deflections, deflections that are
/// not small, and remarks on the files that were read.
std::vector<RunWarning> list_balance_warnings(const Vehicle& vehicle, const RestingSections& sections,
                                              const std::vector<std::string>& file_remarks);

/// Bounds of the vehicle's undamped frequencies.
struct FrequencyBracket {
  Eigen::VectorXd lower_hz, upper_hz;  ///< of mode 1, 2, …, rigid-body modes among them
  double highest_hz = 0.0;             ///< up to which the bounds hold
  /// Whether the true frequency of a mode may be one for which the bounds hold. @param mode  0-based
  bool may_be_in_band(const std::vector<VehicleMode>& modes, std::size_t mode) const;
};

/// Positions of the bodies, values of the force elements, bending moments and neutral directions, as text
/// tables, with the warnings that do not concern the files.
std::string format_equilibrium(const BalanceReport& report);
/// Positions, values and neutral directions as one JSON object, SI units, without the warnings.
support::Json make_equilibrium_json(const BalanceReport& report);

/// Table of the vehicle's modes, with the warnings that do not concern the files.
/// @param kinks      at the balance
/// @param is_steady  about steady motion, not at rest
std::string format_modes(const Model& model, const Vehicle& vehicle, const std::vector<VehicleMode>& modes,
                         const std::vector<Kink>& kinks, const std::vector<RunWarning>& warnings,
                         bool is_steady = false);
/// @param sections  at the equilibrium   @param bracket  null: none
support::Json make_modes_json(const Model& model, const Vehicle& vehicle,
                              const std::vector<VehicleMode>& modes, const SectionStatistics& sections,
                              const FrequencyBracket* bracket = nullptr);
std::string format_bracket(const Vehicle& vehicle, const Model& model, const std::vector<VehicleMode>& modes,
                           const FrequencyBracket& bracket);

}  // namespace sprung::dynamics
