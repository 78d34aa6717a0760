#include "dynamics/mode_choice/watched_quantities.h"

#include <algorithm>

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

void add_forces(const LinearVehicle& vehicle, bool is_judged, WatchedQuantities& watched) {
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
          {"force of " + force->name, Kind::kForce, add_outputs(watched, outputs.pick(forces)), is_judged});
    if (!torques.empty())
      watched.list.push_back({"torque of " + force->name, Kind::kTorque,
                              add_outputs(watched, outputs.pick(torques)), is_judged});
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

void add_moments(const LinearVehicle& vehicle, const LinearOutputs& moments, WatchedQuantities& watched) {
  for (std::size_t b = 0; b < vehicle.model().bodies.size(); ++b) {
    const std::vector<int> rows = find_outputs(
        moments, [&](const OutputSubject& subject) { return subject.object == static_cast<int>(b); });
    if (rows.empty()) continue;
    watched.list.push_back({"bending moments of " + vehicle.model().bodies[b].name, Kind::kMoment,
                            add_outputs(watched, moments.pick(rows))});
  }
}

}  // namespace

bool WatchedQuantities::judges_any() const {
  return std::any_of(list.begin(), list.end(),
                     [](const WatchedQuantity& quantity) { return quantity.is_judged; });
}

WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const JudgedPlaces& places,
                                          const JudgedQuantities& judged) {
  WatchedQuantities watched;
  for (const int marker : places.points) {
    const std::string& name = vehicle.model().markers[static_cast<std::size_t>(marker)].name;
    const std::vector<int> rows = add_outputs(watched, make_point_outputs(vehicle, marker).pick({0, 1}));
    watched.list.push_back({"displacement of " + name, Kind::kDisplacement, rows, judged.points});
    watched.list.push_back({"acceleration of " + name, Kind::kAcceleration, rows, judged.points});
  }
  add_forces(vehicle, judged.forces, watched);  // wheels that leave the ground are remarked from their forces
  if (judged.reactions) add_reactions(vehicle, watched);
  if (judged.moments) add_moments(vehicle, places.moments, watched);
  return watched;
}

}  // namespace sprung::dynamics
