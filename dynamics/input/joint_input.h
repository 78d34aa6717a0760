#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dynamics/input/point_reference.h"
#include "dynamics/joints/joint.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Whether functions of time go on, or stand still at their value at t = 0, as for a static balance.
enum class MotionUse { kMoving, kHeld };

/// What a joint is made from besides its description.
struct JointPlace {
  int marker_a = 0;
  int marker_b = 0;
  double angle = 0.0;  ///< of b's body against a's, as the vehicle file has them [rad]
  MotionUse motions = MotionUse::kMoving;
};

/// A joint as the vehicle file has it: where it is, and how it is made once the markers have their numbers.
struct JointDescription {
  std::string name;
  std::string kind;  ///< the file's `type`
  PointReference a, b;
  support::SourceLocation location;
  std::optional<RelativeCoordinate>
      coordinate;               ///< that prescribed motion may drive; none: the joint leaves none free
  bool needs_distance = false;  ///< its two points must not coincide
  std::function<std::unique_ptr<Joint>(const JointPlace& place)> make;
};

/// Reads one entry of `[[joints]]`: name, type, a, b and the keys of its type. A new kind of joint is one
/// more row in the table of this function's source.
/// @throws support::InputError for a missing, unknown or unfit key; whether the points exist is the vehicle's
/// matter
JointDescription read_joint(const support::TomlTable& table);

}  // namespace sprung::dynamics
