#pragma once

#include <string>
#include <vector>

#include "dynamics/mode_choice/judged_quantities.h"
#include "dynamics/response/linear_outputs.h"

namespace sprung::dynamics {

/// A vector or scalar by which modes are judged; its components are rows of the outputs.
struct WatchedQuantity {
  enum class Kind { kDisplacement, kAcceleration, kForce, kTorque, kMoment };
  static constexpr std::size_t kNumKinds = 5;
  std::string name;  ///< "acceleration of chassis.seat", "reaction of front_long_chassis"
  Kind kind = Kind::kForce;
  std::vector<int> rows;  ///< of the outputs; an acceleration's are those of the displacement
  bool is_judged = true;  ///< else only its values are wanted
};

/// The quantities by which modes may be judged: displacement and acceleration (x, y) of the points asked for,
/// forces and torques of all force elements that are not given in time, reactions of all joints, and the
/// bending moments of each body as one vector.
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
struct WatchedQuantities {
  LinearOutputs outputs;
  std::vector<WatchedQuantity> list;

  std::size_t size() const { return list.size(); }
  bool judges_any() const;
};

/// What is judged: the points, and bending moments at places along bodies.
struct JudgedPlaces {
  std::vector<int> points;  ///< markers
  LinearOutputs moments;    ///< subjects kMoment, or none
};

/// @param places  displacement and acceleration of each point come first, in this order
WatchedQuantities make_watched_quantities(const LinearVehicle& vehicle, const JudgedPlaces& places,
                                          const JudgedQuantities& judged);

}  // namespace sprung::dynamics
