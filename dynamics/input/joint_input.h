#pragma once

#include <functional>
#include <memory>
#include <string>

#include "dynamics/input/point_reference.h"
#include "dynamics/joints/joint.h"
#include "tools/support/toml.h"

namespace sprung::dynamics {

/// A joint as the vehicle file has it: where it is, and how it is made once the markers have their numbers.
struct JointDescription {
  std::string name;
  std::string kind;  ///< the file's `type`
  PointReference a, b;
  support::SourceLocation location;
  std::function<std::unique_ptr<Joint>(int marker_a, int marker_b)> make;
};

/// Reads one entry of `[[joints]]`: name, type, a, b and the keys of its type. A new kind of joint is one
/// more row in the table of this function's source.
/// @throws support::InputError for a missing, unknown or unfit key; whether the points exist is the vehicle's
/// matter
JointDescription read_joint(const support::TomlTable& table);

}  // namespace sprung::dynamics
