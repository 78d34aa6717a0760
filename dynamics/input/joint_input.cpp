#include "dynamics/input/joint_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "dynamics/input/input_values.h"
#include "dynamics/input/time_function_input.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/joints/revolute_joint.h"

namespace sprung::dynamics {

namespace {

using Kind = RelativeCoordinate::Kind;

// Reads the keys of one type of joint into a description that has name, points and place already.
using JointReader = void (*)(const support::TomlTable& table, JointDescription& joint);

// @param make_parts  (place) → CoordinateJoint::Parts
template <typename MakeParts>
void make_of_coordinates(JointDescription& joint, MakeParts make_parts) {
  joint.make = [name = joint.name, location = joint.location, make_parts](const JointPlace& place) {
    return std::make_unique<CoordinateJoint>(name, place.marker_a, place.marker_b, location,
                                             make_parts(place));
  };
}

std::optional<double> read_angle(const support::TomlTable& table) {
  const std::optional<support::TomlValue> angle = table.find("angle");
  return angle ? std::optional(angle->number(support::any("rad"))) : std::nullopt;
}

void read_revolute(const support::TomlTable& /*table*/, JointDescription& joint) {
  joint.coordinate = RelativeCoordinate(Kind::kAngle);
  joint.make = [name = joint.name, location = joint.location](const JointPlace& place) {
    return std::make_unique<RevoluteJoint>(name, place.marker_a, place.marker_b, location);
  };
}

void read_translational(const support::TomlTable& table, JointDescription& joint) {
  const Eigen::Vector2d axis = read_direction(table.at("axis"));
  joint.coordinate = RelativeCoordinate(Kind::kAlong, axis);
  make_of_coordinates(joint, [axis, angle = read_angle(table)](const JointPlace& place) {
    return make_translational_joint(axis, angle.value_or(place.angle));
  });
}

void read_fixed(const support::TomlTable& table, JointDescription& joint) {
  make_of_coordinates(joint, [angle = read_angle(table)](const JointPlace& place) {
    return make_fixed_joint(angle.value_or(place.angle));
  });
}

void read_distance(const support::TomlTable& table, JointDescription& joint) {
  const support::TomlValue value = table.at("length");
  const TimeFunction length = read_time_function(value, "m", TimeFunctionUse::kMotion);
  if (!(length.value(0.0) > 0.0)) throw value.error(fmt::format("must be > 0 m, got {}", length.value(0.0)));
  joint.needs_distance = true;
  make_of_coordinates(joint, [length](const JointPlace& place) {
    return make_distance_joint(place.motions == MotionUse::kMoving ? length
                                                                   : TimeFunction(length.value(0.0)));
  });
}

void read_pin_in_slot(const support::TomlTable& table, JointDescription& joint) {
  const Eigen::Vector2d axis = read_direction(table.at("axis"));
  joint.coordinate = RelativeCoordinate(Kind::kAlong, axis);
  make_of_coordinates(joint, [axis](const JointPlace& /*place*/) { return make_pin_in_slot_joint(axis); });
}

const std::vector<std::pair<std::string, JointReader>>& joint_readers() {
  static const std::vector<std::pair<std::string, JointReader>> readers{
      {"revolute", read_revolute}, {"translational", read_translational}, {"fixed", read_fixed},
      {"distance", read_distance}, {"pin-in-slot", read_pin_in_slot},
  };
  return readers;
}

}  // namespace

JointDescription read_joint(const support::TomlTable& table) {
  JointDescription joint;
  joint.name = table.string("name");
  joint.location = table.at("name").location();
  check_name(joint.name, "joint", joint.location);

  std::vector<std::string> kinds;
  for (const auto& [kind, reader] : joint_readers()) kinds.push_back(kind);
  joint.kind = table.at("type").one_of(kinds);
  joint.a = read_point(table.at("a"));
  joint.b = read_point(table.at("b"));

  const auto found = std::find(kinds.begin(), kinds.end(), joint.kind);
  joint_readers()[static_cast<std::size_t>(found - kinds.begin())].second(table, joint);
  table.reject_unknown_keys();
  return joint;
}

}  // namespace sprung::dynamics
