#include "dynamics/mode_choice/watched_quantities.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;

// Adds the outputs as rows behind those there are. @return their places
std::vector<int> append(WatchedQuantities& watched, const LinearOutputs& outputs) {
  std::vector<int> rows;
  for (int i = 0; i < outputs.size(); ++i) rows.push_back(watched.outputs.size() + i);
  if (watched.outputs.size() == 0) {
    watched.outputs = outputs;
  } else {
    watched.outputs.append(outputs);
  }
  return rows;
}

// Outputs of a group by the ends of their names, those that there are.
std::vector<int> find_outputs(const LinearOutputs& outputs, const std::string& group,
                              std::initializer_list<std::string_view> ends) {
  std::vector<int> rows;
  for (int i = 0; i < outputs.size(); ++i) {
    for (const std::string_view end : ends) {
      if (outputs.names[static_cast<std::size_t>(i)] == fmt::format("{}/{}", group, end)) rows.push_back(i);
    }
  }
  return rows;
}

void add_forces(const LinearVehicle& vehicle, WatchedQuantities& watched) {
  const LinearOutputs outputs = make_force_outputs(vehicle);
  for (const auto& force : vehicle.model().forces) {
    if (force->kind() == "applied") continue;
    const std::string group = "forces/" + force->name;
    const std::vector<int> forces = find_outputs(outputs, group, {"force", "longitudinal_force"});
    const std::vector<int> torques = find_outputs(outputs, group, {"torque"});
    if (!forces.empty())
      watched.list.push_back(
          {"force of " + force->name, Kind::kForce, append(watched, outputs.pick(forces))});
    if (!torques.empty())
      watched.list.push_back(
          {"torque of " + force->name, Kind::kTorque, append(watched, outputs.pick(torques))});
  }
}

void add_reactions(const LinearVehicle& vehicle, WatchedQuantities& watched) {
  const LinearOutputs outputs = make_reaction_outputs(vehicle);
  for (const auto& joint : vehicle.model().joints) {
    const std::string group = "joints/" + joint->name;
    const std::vector<int> forces = find_outputs(outputs, group, {"reaction.x", "reaction.y"});
    const std::vector<int> torques = find_outputs(outputs, group, {"reaction.torque"});
    watched.list.push_back(
        {"reaction of " + joint->name, Kind::kForce, append(watched, outputs.pick(forces))});
    if (joint->kind() == "revolute") continue;
    watched.list.push_back(
        {"reaction torque of " + joint->name, Kind::kTorque, append(watched, outputs.pick(torques))});
  }
}

}  // namespace

WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const std::vector<int>& points) {
  WatchedQuantities watched;
  for (const int marker : points) {
    const std::string& name = vehicle.model().markers[static_cast<std::size_t>(marker)].name;
    const std::vector<int> rows = append(watched, make_point_outputs(vehicle, marker).pick({0, 1}));
    watched.list.push_back({"displacement of " + name, Kind::kDisplacement, rows});
    watched.list.push_back({"acceleration of " + name, Kind::kAcceleration, rows});
  }
  add_forces(vehicle, watched);
  add_reactions(vehicle, watched);
  return watched;
}

}  // namespace sprung::dynamics
