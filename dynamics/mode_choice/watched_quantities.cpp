#include "dynamics/mode_choice/watched_quantities.h"

namespace sprung::dynamics {

namespace {

using Kind = WatchedQuantity::Kind;

// Adds outputs after the present ones. @return their rows
std::vector<int> add_outputs(WatchedQuantities& watched, const LinearOutputs& outputs) {
  std::vector<int> rows;
  for (int i = 0; i < outputs.size(); ++i) rows.push_back(watched.outputs.size() + i);
  if (watched.outputs.size() == 0) {
    watched.outputs = outputs;
  } else {
    watched.outputs.append(outputs);
  }
  return rows;
}

// Rows of the outputs whose subject satisfies a condition.
template <typename Fits>
std::vector<int> find_outputs(const LinearOutputs& outputs, Fits fits) {
  std::vector<int> rows;
  for (int i = 0; i < outputs.size(); ++i) {
    if (fits(outputs.subjects[static_cast<std::size_t>(i)])) rows.push_back(i);
  }
  return rows;
}

void add_forces(const LinearVehicle& vehicle, WatchedQuantities& watched) {
  const LinearOutputs outputs = make_force_outputs(vehicle);
  for (std::size_t f = 0; f < vehicle.model().forces.size(); ++f) {
    const auto& force = vehicle.model().forces[f];
    const auto is_of_force = [&](const OutputSubject& subject) {
      return subject.object == static_cast<int>(f);
    };
    const std::vector<int> forces = find_outputs(outputs, [&](const OutputSubject& subject) {
      return is_of_force(subject) &&
             (subject.role == ChannelRole::kForce || subject.role == ChannelRole::kLongitudinalForce);
    });
    const std::vector<int> torques = find_outputs(outputs, [&](const OutputSubject& subject) {
      return is_of_force(subject) && subject.role == ChannelRole::kTorque;
    });
    if (!forces.empty())
      watched.list.push_back(
          {"force of " + force->name, Kind::kForce, add_outputs(watched, outputs.pick(forces))});
    if (!torques.empty())
      watched.list.push_back(
          {"torque of " + force->name, Kind::kTorque, add_outputs(watched, outputs.pick(torques))});
  }
}

void add_reactions(const LinearVehicle& vehicle, WatchedQuantities& watched) {
  const LinearOutputs outputs = make_reaction_outputs(vehicle);
  for (std::size_t j = 0; j < vehicle.model().joints.size(); ++j) {
    const auto& joint = vehicle.model().joints[j];
    const auto is_of_joint = [&](const OutputSubject& subject) {
      return subject.object == static_cast<int>(j);
    };
    const std::vector<int> forces = find_outputs(
        outputs, [&](const OutputSubject& subject) { return is_of_joint(subject) && subject.component < 2; });
    const std::vector<int> torques = find_outputs(outputs, [&](const OutputSubject& subject) {
      return is_of_joint(subject) && subject.component == 2;
    });
    watched.list.push_back(
        {"reaction of " + joint->name, Kind::kForce, add_outputs(watched, outputs.pick(forces))});
    if (!joint->carries_torque()) continue;
    watched.list.push_back(
        {"reaction torque of " + joint->name, Kind::kTorque, add_outputs(watched, outputs.pick(torques))});
  }
}

}  // namespace

WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const std::vector<int>& points) {
  WatchedQuantities watched;
  for (const int marker : points) {
    const std::string& name = vehicle.model().markers[static_cast<std::size_t>(marker)].name;
    const std::vector<int> rows = add_outputs(watched, make_point_outputs(vehicle, marker).pick({0, 1}));
    watched.list.push_back({"displacement of " + name, Kind::kDisplacement, rows});
    watched.list.push_back({"acceleration of " + name, Kind::kAcceleration, rows});
  }
  add_forces(vehicle, watched);
  add_reactions(vehicle, watched);
  return watched;
}

}  // namespace sprung::dynamics
