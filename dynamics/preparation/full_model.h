#pragma once

#include <optional>
#include <vector>

#include "dynamics/preparation/prepared_run.h"

namespace sprung::dynamics {

/// All modes that the superelements of a vehicle have.
ModeSelection select_all_modes(const Vehicle& vehicle);

/// Damping ratios of the run that hold for all modes: a single one of a body does, a list does not name those
/// left out.
ModalDamping keep_single_ratios(const DampingRequests& requests, const Vehicle& vehicle);

/// A prepared vehicle on level ground with all modes that its superelements have. No body is stiffened.
struct FullVehicle {
  Model model;
  /// The equilibrium of the prepared vehicle, nq: the modes left out are at zero.
  Eigen::VectorXd q;
  std::vector<int> left_out;            ///< coordinates of these modes
  std::vector<std::string> incomplete;  ///< bodies that have not all of their modes: "frame (1 of 12)"
};
/// None where no mode was left out. @param prepared  in equilibrium
std::optional<FullVehicle> make_full_vehicle(const PreparedRun& prepared);

}  // namespace sprung::dynamics
