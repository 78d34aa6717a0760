#include "dynamics/bracket/axial_change.h"

#include <vector>

#include "dynamics/linear/vehicle_modes.h"

namespace sprung::dynamics {

std::optional<Eigen::VectorXd> calc_stiffened_frequencies(const Vehicle& vehicle,
                                                          const ModeSelection& selection,
                                                          const PlacedRoad& road, const Eigen::VectorXd& q) {
  StiffenedBodies stiffened;
  for (const BodyDescription& body : vehicle.bodies) {
    const reduce::Superelement* superelement = vehicle.superelement_of(body);
    const auto modes = selection.find(body.name);
    if (!superelement || !superelement->geometric_stiffness || modes == selection.end()) continue;
    if (!modes->second.empty() && modes->second.back() <= superelement->geometric_stiffness->num_modes())
      stiffened.insert(body.name);
  }
  if (stiffened.empty()) return std::nullopt;
  const Model model = make_model(vehicle, selection, road, {}, MotionUse::kHeld, stiffened);
  const std::vector<VehicleMode> modes = calc_vehicle_modes(model, find_equilibrium(model, q));
  Eigen::VectorXd frequencies(static_cast<Eigen::Index>(modes.size()));
  for (Eigen::Index k = 0; k < frequencies.size(); ++k)
    frequencies[k] = modes[static_cast<std::size_t>(k)].undamped_frequency_hz;
  return frequencies;
}

}  // namespace sprung::dynamics
