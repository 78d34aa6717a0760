#pragma once

#include <string>
#include <vector>

#include "dynamics/linear/linear_outputs.h"

namespace sprung::dynamics {

/// A vector or scalar by which modes are judged; its components are rows of the outputs.
struct WatchedQuantity {
  enum class Kind { kDisplacement, kAcceleration, kForce, kTorque };
  static constexpr std::size_t kNumKinds = 4;
  std::string name;  ///< "acceleration of chassis.seat", "reaction of front_long_chassis"
  Kind kind = Kind::kForce;
  std::vector<int> rows;  ///< of the outputs; an acceleration's are those of the displacement
};

/// The quantities by which modes are judged: displacement and acceleration (x, y) of the points asked for,
/// reactions of all joints, forces and torques of all force elements that are not given in time.
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
struct WatchedQuantities {
  LinearOutputs outputs;
  std::vector<WatchedQuantity> list;

  std::size_t size() const { return list.size(); }
};

/// @param points  markers; displacement and acceleration of each come first, in this order
WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const std::vector<int>& points);

}  // namespace sprung::dynamics
