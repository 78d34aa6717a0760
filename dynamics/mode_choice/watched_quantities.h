#pragma once

#include <string>
#include <vector>

#include "dynamics/linear/linear_outputs.h"

namespace sprung::dynamics {

/// A vector or scalar by which modes are judged: the size of some rows of outputs together.
struct WatchedQuantity {
  enum class Kind { kDisplacement, kAcceleration, kForce, kTorque };
  static constexpr std::size_t kNumKinds = 4;
  std::string name;  ///< "acceleration of chassis.seat", "reaction of front_long_chassis"
  Kind kind = Kind::kForce;
  std::vector<int> rows;  ///< of the outputs; an acceleration's are those of the displacement
};

/// What a user of a run cares about: displacement and acceleration (x, y) of the points asked for, reactions
/// of all joints, forces and torques of all force elements that are not given in time.
struct WatchedQuantities {
  LinearOutputs outputs;
  std::vector<WatchedQuantity> list;

  std::size_t size() const { return list.size(); }
};

/// @param points  markers; displacement and acceleration of each come first, in this order
WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const std::vector<int>& points);

}  // namespace sprung::dynamics
