#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "dynamics/element_input/history_input.h"
#include "dynamics/element_input/point_reference.h"
#include "dynamics/joints/joint.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Whether functions of time vary, or keep their value at t = 0, as for static equilibrium.
enum class MotionUse { kMoving, kHeld };

/// What a joint needs besides its description.
struct JointPlace {
  int marker_a = 0;
  int marker_b = 0;
  double angle = 0.0;  ///< of b's body relative to a's in the vehicle file [rad]
  MotionUse motions = MotionUse::kMoving;
};

/// Parameters of a joint of each kind. Without an angle, the one between the bodies in the vehicle file is
/// kept.
struct RevoluteParameters {};
struct TranslationalParameters {
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< in the axes of a's body
  std::optional<double> angle;                      ///< of b relative to a [rad]
};
struct FixedParameters {
  std::optional<double> angle;  ///< of b relative to a [rad]
};
struct DistanceParameters {
  TimeFunction length;  ///< > 0 [m]
};
struct PinInSlotParameters {
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< in the axes of a's body
};
using JointParameters = std::variant<RevoluteParameters, TranslationalParameters, FixedParameters,
                                     DistanceParameters, PinInSlotParameters>;

/// A joint as described in the vehicle file.
struct JointDescription {
  std::string name;
  std::string kind;  ///< the file's `type`
  PointReference a, b;
  support::SourceLocation location;
  /// The joint's coordinate, where prescribed motion may drive it.
  std::optional<RelativeCoordinate> drivable;
  bool along_line = false;  ///< acts along the line between its two points, which must not coincide
  JointParameters parameters;
};

/// Reads one entry of `[[joints]]`: name, type, a, b and the keys of its type, by the table `joint_readers`.
/// It does not check that the points exist; `read_vehicle` does.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
/// Checked by tests/dynamics/element_input/joint_input_test.cpp
JointDescription read_joint(const support::TomlTable& table, HistoryFiles& histories);

/// Makes the joint of a description.
std::unique_ptr<Joint> make_joint(const JointDescription& joint, const JointPlace& place);

}  // namespace sprung::dynamics
