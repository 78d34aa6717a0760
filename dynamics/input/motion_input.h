#pragma once

#include <memory>
#include <span>
#include <string>

#include "dynamics/input/joint_input.h"
#include "dynamics/input/point_reference.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Prescribed motion as the vehicle file has it: of a joint's coordinate, or of a point against the ground.
struct MotionDescription {
  std::string name;
  PointReference a, b;  ///< the joint's points; or "ground.origin" and the moved point
  RelativeCoordinate coordinate = RelativeCoordinate(RelativeCoordinate::Kind::kX);
  TimeFunction value;
  support::SourceLocation location;
};

/// Reads one entry of `[[motions]]`: name, `joint` or `point` with `coordinate`, and the function of time.
/// @param joints  of the vehicle
/// @throws support::InputError for a missing, unknown or unfit key, and for a joint that has no free
/// coordinate; whether the point exists is the vehicle's matter
MotionDescription read_motion(const support::TomlTable& table, std::span<const JointDescription> joints);

/// The motion described, as the joint that it is to the solver.
std::unique_ptr<Joint> make_joint(const MotionDescription& motion, const JointPlace& place);

}  // namespace sprung::dynamics
