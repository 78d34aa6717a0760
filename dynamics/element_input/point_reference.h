#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The first part of the names of points of the ground: "ground.origin".
inline constexpr std::string_view kGroundName = "ground";

/// A point as an input file names it: "body.point", or "ground.point".
struct PointReference {
  std::string name;
  support::SourceLocation location;
};

/// Reads a reference; `check_point` checks that it names a point of the vehicle.
/// @throws support::InputError if it is not of the form "body.point"
PointReference read_point(const support::TomlValue& value);

/// Checks that a reference names a point of the vehicle.
/// @param known  names of all points of the vehicle
/// @throws support::InputError at the reference otherwise, with the nearest known point
/// Checked by tests/dynamics/input/vehicle_test.cpp
void check_point(const PointReference& reference, std::span<const std::string> known);

/// The part of "body.point" before the dot.
std::string body_of_point(const std::string& point_name);

/// Checks a name that the user gives to a body, point, joint or force: it consists of letters, digits, '_'
/// and
/// '-', so that it can be used in "body.point", in a key and in the results file.
/// @param what  for the message: "body"
/// @throws support::InputError at `location` for another name
void check_name(const std::string& name, const std::string& what, const support::SourceLocation& location);

}  // namespace sprung::dynamics
