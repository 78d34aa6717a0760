#include "dynamics/element_input/joint_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "dynamics/element_input/input_values.h"
#include "dynamics/element_input/time_function_input.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/joints/revolute_joint.h"

namespace sprung::dynamics {

namespace {

using Kind = RelativeCoordinate::Kind;

// Reads the keys of one type of joint into a description that has its name, points and location already.
using JointReader = void (*)(const support::TomlTable& table, JointDescription& joint,
                             HistoryFiles& histories);

std::optional<double> read_angle(const support::TomlTable& table) {
  const std::optional<support::TomlValue> angle = table.find("angle");
  return angle ? std::optional(angle->number(support::any("rad"))) : std::nullopt;
}

void read_revolute(const support::TomlTable& /*table*/, JointDescription& joint,
                   HistoryFiles& /*histories*/) {
  joint.drivable = RelativeCoordinate(Kind::kAngle);
  joint.parameters = RevoluteParameters{};
}

void read_translational(const support::TomlTable& table, JointDescription& joint,
                        HistoryFiles& /*histories*/) {
  const Eigen::Vector2d axis = read_direction(table.at("axis"));
  joint.drivable = RelativeCoordinate(Kind::kAlong, axis);
  joint.parameters = TranslationalParameters{.axis = axis, .angle = read_angle(table)};
}

void read_fixed(const support::TomlTable& table, JointDescription& joint, HistoryFiles& /*histories*/) {
  joint.parameters = FixedParameters{.angle = read_angle(table)};
}

void read_distance(const support::TomlTable& table, JointDescription& joint, HistoryFiles& histories) {
  const support::TomlValue value = table.at("length");
  const TimeFunction length = read_time_function(value, "m", TimeFunctionUse::kMotion, histories);
  if (!(length.value(0.0) > 0.0)) throw value.error(fmt::format("must be > 0 m, got {}", length.value(0.0)));
  joint.along_line = true;
  joint.parameters = DistanceParameters{.length = length};
}

void read_pin_in_slot(const support::TomlTable& table, JointDescription& joint, HistoryFiles& /*histories*/) {
  const Eigen::Vector2d axis = read_direction(table.at("axis"));
  joint.drivable = RelativeCoordinate(Kind::kAlong, axis);
  joint.parameters = PinInSlotParameters{.axis = axis};
}

const std::vector<std::pair<std::string, JointReader>>& joint_readers() {
  static const std::vector<std::pair<std::string, JointReader>> readers{
      {"revolute", read_revolute}, {"translational", read_translational}, {"fixed", read_fixed},
      {"distance", read_distance}, {"pin-in-slot", read_pin_in_slot},
  };
  return readers;
}

CoordinateJoint::Parts make_parts(const TranslationalParameters& parameters, const JointPlace& place) {
  return make_translational_joint(parameters.axis, parameters.angle.value_or(place.angle));
}

CoordinateJoint::Parts make_parts(const FixedParameters& parameters, const JointPlace& place) {
  return make_fixed_joint(parameters.angle.value_or(place.angle));
}

CoordinateJoint::Parts make_parts(const DistanceParameters& parameters, const JointPlace& place) {
  const TimeFunction& length = parameters.length;
  return make_distance_joint(place.motions == MotionUse::kMoving ? length : TimeFunction(length.value(0.0)));
}

CoordinateJoint::Parts make_parts(const PinInSlotParameters& parameters, const JointPlace& /*place*/) {
  return make_pin_in_slot_joint(parameters.axis);
}

template <typename Parameters>
std::unique_ptr<Joint> place_joint(const JointDescription& joint, const Parameters& parameters,
                                   const JointPlace& place) {
  if constexpr (std::is_same_v<Parameters, RevoluteParameters>) {
    return std::make_unique<RevoluteJoint>(joint.name, place.marker_a, place.marker_b, joint.location);
  } else {
    return std::make_unique<CoordinateJoint>(joint.name, place.marker_a, place.marker_b, joint.location,
                                             make_parts(parameters, place));
  }
}

}  // namespace

JointDescription read_joint(const support::TomlTable& table, HistoryFiles& histories) {
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
  joint_readers()[static_cast<std::size_t>(found - kinds.begin())].second(table, joint, histories);
  table.reject_unknown_keys();
  return joint;
}

std::unique_ptr<Joint> make_joint(const JointDescription& joint, const JointPlace& place) {
  return std::visit([&](const auto& parameters) { return place_joint(joint, parameters, place); },
                    joint.parameters);
}

}  // namespace sprung::dynamics
