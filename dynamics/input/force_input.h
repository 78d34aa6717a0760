#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/forces/force_element.h"
#include "dynamics/input/point_reference.h"
#include "dynamics/road/road.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// A force element as the vehicle file has it: where it acts, and how it is made once the markers have their
/// numbers.
struct ForceDescription {
  std::string name;
  std::string kind;                    ///< the file's `type`
  std::vector<PointReference> points;  ///< where it acts, in the order `make` wants their markers
  bool along_line = false;  ///< acts along the line between its two points, which must not coincide
  bool on_road = false;     ///< a tyre: its first point is the wheel's centre
  support::SourceLocation location;
  std::function<std::unique_ptr<ForceElement>(std::span<const int> markers, const PlacedRoad& road)> make;
};

/// Reads one entry of `[[forces]]`: name, type and the keys of its type. A new kind of force is one more row
/// in the table of this function's source.
/// @throws support::InputError for a missing, unknown or unfit key; whether the points exist is the vehicle's
/// matter
ForceDescription read_force(const support::TomlTable& table);

}  // namespace sprung::dynamics
