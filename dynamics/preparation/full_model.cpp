#include "dynamics/preparation/full_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace sprung::dynamics {

ModeSelection select_all_modes(const Vehicle& vehicle) {
  ModeSelection all;
  for (const BodyDescription& body : vehicle.bodies) {
    const reduce::Superelement* superelement = vehicle.superelement_of(body);
    if (!superelement) continue;
    std::vector<int>& numbers = all[body.name];
    numbers.resize(static_cast<std::size_t>(superelement->num_modes()));
    std::iota(numbers.begin(), numbers.end(), 1);
  }
  return all;
}

ModalDamping keep_single_ratios(const DampingRequests& requests, const Vehicle& vehicle) {
  ModalDamping damping;
  for (const auto& [body, request] : requests) {
    if (request.ratios.size() == 1 && vehicle.superelement_of(*vehicle.find_body(body)))
      damping[body] = request.ratios;
  }
  return damping;
}

std::optional<FullVehicle> make_full_vehicle(const PreparedRun& prepared) {
  const Vehicle& vehicle = prepared.vehicle;
  const ModeSelection all = select_all_modes(vehicle);
  FullVehicle full{
      .model = make_model(vehicle, all, {prepared.level_road.get(), vehicle.direction, 0.0},
                          keep_single_ratios(prepared.run.modal_damping, vehicle), MotionUse::kHeld),
      .q = {},
      .left_out = {},
      .incomplete = {}};
  const Model& chosen = prepared.balance_model;
  if (full.model.num_coordinates == chosen.num_coordinates) return std::nullopt;
  full.q = Eigen::VectorXd::Zero(full.model.num_coordinates);
  for (std::size_t b = 0; b < chosen.bodies.size(); ++b) {
    const Body &body = full.model.bodies[b], &part = chosen.bodies[b];
    full.q.segment<3>(body.first_coordinate) = prepared.equilibrium->q.segment<3>(part.first_coordinate);
    const std::vector<int>& numbers = part.mode_numbers;
    for (int k = 0; k < body.num_modes(); ++k) {
      const int coordinate = body.first_coordinate + 3 + k;
      const auto found =
          std::find(numbers.begin(), numbers.end(), body.mode_numbers[static_cast<std::size_t>(k)]);
      if (found == numbers.end()) {
        full.left_out.push_back(coordinate);
      } else {
        const auto place = static_cast<int>(found - numbers.begin());
        full.q[coordinate] = prepared.equilibrium->q[part.first_coordinate + 3 + place];
      }
    }
    if (part.num_modes() < body.num_modes())
      full.incomplete.push_back(fmt::format("{} ({} of {})", body.name, part.num_modes(), body.num_modes()));
  }
  return full;
}

}  // namespace sprung::dynamics
