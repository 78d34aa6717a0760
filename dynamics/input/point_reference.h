#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The name that points of the ground have in front.
inline constexpr std::string_view kGroundName = "ground";

/// A point as an input file names it: "body.point", or "ground.point".
struct PointReference {
  std::string name;
  support::SourceLocation location;
};

/// A reference as the file has it; that it names a point of the vehicle is checked by `check_point`.
PointReference read_point(const support::TomlValue& value);

/// @param known  names of all points of the vehicle
/// @throws support::InputError at the reference's place, naming the nearest known point
void check_point(const PointReference& reference, std::span<const std::string> known);

/// The part of "body.point" before the dot.
std::string body_of_point(const std::string& point_name);

/// A name given by the user, of a body, point, joint or force: letters, digits, '_' and '-', so that it can
/// stand in "body.point", in a key and in the results file.
/// @throws support::InputError at `location`, naming `what` and the name
void check_name(const std::string& name, const std::string& what, const support::SourceLocation& location);

}  // namespace sprung::dynamics
