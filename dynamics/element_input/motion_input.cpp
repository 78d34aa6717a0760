#include "dynamics/element_input/motion_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "dynamics/element_input/input_values.h"
#include "dynamics/element_input/time_function_input.h"
#include "dynamics/joints/coordinate_joint.h"

namespace sprung::dynamics {

namespace {

using Kind = RelativeCoordinate::Kind;

void read_driven_joint(const support::TomlValue& value, std::span<const JointDescription> joints,
                       MotionDescription& motion) {
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const JointDescription& joint) {
    return joint.name == value.string();
  });
  if (found == joints.end()) {
    std::vector<std::string> names;
    for (const JointDescription& joint : joints) names.push_back(joint.name);
    throw value.error(fmt::format("names no joint of the vehicle, '{}'{}", value.string(),
                                  support::nearest_name_hint(value.string(), names)));
  }
  if (!found->drivable) {
    throw value.error(fmt::format("names a {} joint, which has no coordinate to be driven{}", found->kind,
                                  std::holds_alternative<DistanceParameters>(found->parameters)
                                      ? "; its 'length' may be a function of time"
                                      : ""));
  }
  motion.a = found->a;
  motion.b = found->b;
  motion.coordinate = *found->drivable;
}

void read_driven_point(const support::TomlTable& table, MotionDescription& motion) {
  static const std::array<std::string, 3> kCoordinates{"x", "y", "angle"};
  motion.b = read_point(table.at("point"));
  motion.a = {"ground.origin", motion.b.location};
  const std::string& coordinate = table.at("coordinate").one_of(kCoordinates);
  motion.coordinate = RelativeCoordinate(coordinate == "x"   ? Kind::kX
                                         : coordinate == "y" ? Kind::kY
                                                             : Kind::kAngle);
}

}  // namespace

MotionDescription read_motion(const support::TomlTable& table, std::span<const JointDescription> joints,
                              HistoryFiles& histories) {
  MotionDescription motion;
  motion.name = table.string("name");
  motion.location = table.at("name").location();
  check_name(motion.name, "motion", motion.location);
  constexpr std::array<std::string_view, 2> kWays{"joint", "point"};
  table.find("coordinate"), table.find("function");
  if (find_only_key(table, kWays, "either a 'joint', or a 'point' and its 'coordinate'") == "joint") {
    read_driven_joint(table.at("joint"), joints, motion);
    if (const std::optional<support::TomlValue> coordinate = table.find("coordinate")) {
      throw coordinate->error("must be left out: the joint has its own");
    }
  } else {
    read_driven_point(table, motion);
  }
  motion.value = read_time_function(table.at("function"), motion.coordinate.is_angle() ? "rad" : "m",
                                    TimeFunctionUse::kMotion, histories);
  table.reject_unknown_keys();
  return motion;
}

std::unique_ptr<Joint> make_joint(const MotionDescription& motion, const JointPlace& place) {
  const TimeFunction& moving = motion.value;
  const TimeFunction value = place.motions == MotionUse::kMoving ? moving : TimeFunction(moving.value(0.0));
  return std::make_unique<CoordinateJoint>(motion.name, place.marker_a, place.marker_b, motion.location,
                                           make_motion(motion.coordinate, value));
}

}  // namespace sprung::dynamics
