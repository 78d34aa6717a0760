#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

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

/// What a joint of each kind is made with; an angle that is not given is the one in the vehicle file.
struct RevoluteParameters {};
struct TranslationalParameters {
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< in the axes of a's body
  std::optional<double> angle;                      ///< of b against a [rad]
};
struct FixedParameters {
  std::optional<double> angle;  ///< of b against a [rad]
};
struct DistanceParameters {
  TimeFunction length;  ///< > 0 [m]
};
struct PinInSlotParameters {
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< in the axes of a's body
};
using JointParameters = std::variant<RevoluteParameters, TranslationalParameters, FixedParameters,
                                     DistanceParameters, PinInSlotParameters>;

/// A joint as the vehicle file has it.
struct JointDescription {
  std::string name;
  std::string kind;  ///< the file's `type`
  PointReference a, b;
  support::SourceLocation location;
  std::optional<RelativeCoordinate>
      coordinate;               ///< that prescribed motion may drive; none: the joint leaves none free
  bool needs_distance = false;  ///< its two points must not coincide
  JointParameters parameters;
};

/// Reads one entry of `[[joints]]`: name, type, a, b and the keys of its type. A new kind of joint is one
/// more row in the table of this function's source.
/// @throws support::InputError for a missing, unknown or unfit key; whether the points exist is the vehicle's
/// matter
JointDescription read_joint(const support::TomlTable& table);

/// The joint described.
std::unique_ptr<Joint> make_joint(const JointDescription& joint, const JointPlace& place);

}  // namespace sprung::dynamics
