#pragma once

#include <memory>
#include <span>
#include <string>

#include "dynamics/element_input/joint_input.h"
#include "dynamics/element_input/point_reference.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Prescribed motion as described in the vehicle file: of a joint's coordinate, or of a point relative to the
/// ground.
struct MotionDescription {
  std::string name;
  PointReference a, b;  ///< the joint's points; or "ground.origin" and the moved point
  RelativeCoordinate coordinate = RelativeCoordinate(RelativeCoordinate::Kind::kX);
  TimeFunction value;
  support::SourceLocation location;
};

/// Reads one entry of `[[motions]]`: name, `joint` or `point` with `coordinate`, and the function of time. It
/// does not check that the point exists; `read_vehicle` does.
/// @param joints  of the vehicle
/// @throws support::InputError for a key that is missing, unknown or has a bad value, and for a joint without
///         a free coordinate
/// Checked by tests/dynamics/element_input/motion_input_test.cpp
MotionDescription read_motion(const support::TomlTable& table, std::span<const JointDescription> joints,
                              HistoryFiles& histories);

/// Makes the joint that prescribes a motion.
std::unique_ptr<Joint> make_joint(const MotionDescription& motion, const JointPlace& place);

}  // namespace sprung::dynamics
