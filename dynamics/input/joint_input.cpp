#include "dynamics/input/joint_input.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "dynamics/joints/revolute_joint.h"

namespace sprung::dynamics {

namespace {

// Reads the keys of one type of joint into a description that has name, points and place already.
using JointReader = void (*)(const support::TomlTable& table, JointDescription& joint);

void read_revolute(const support::TomlTable& /*table*/, JointDescription& joint) {
  joint.make = [name = joint.name, location = joint.location](int marker_a, int marker_b) {
    return std::make_unique<RevoluteJoint>(name, marker_a, marker_b, location);
  };
}

const std::vector<std::pair<std::string, JointReader>>& joint_readers() {
  static const std::vector<std::pair<std::string, JointReader>> readers{
      {"revolute", read_revolute},
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
