#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "dynamics/forces/applied_force.h"
#include "dynamics/forces/rotational_spring_damper.h"
#include "dynamics/forces/spring_damper.h"
#include "dynamics/forces/tyre.h"
#include "dynamics/input/point_reference.h"
#include "dynamics/road/road.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// What a tyre of either kind is made with.
struct TyreDescription {
  bool is_distributed = false;  ///< touches the road along a length of it
  Tyre::Parameters parameters;
};

/// What a force element of any kind is made with.
using ForceParameters = std::variant<SpringDamper::Parameters, RotationalSpringDamper::Parameters,
                                     AppliedForce::Parameters, TyreDescription>;

/// A force element as the vehicle file has it.
struct ForceDescription {
  std::string name;
  std::string kind;                    ///< the file's `type`
  std::vector<PointReference> points;  ///< where it acts
  bool along_line = false;  ///< acts along the line between its two points, which must not coincide
  bool on_road = false;     ///< a tyre: its first point is the wheel's centre
  support::SourceLocation location;
  ForceParameters parameters;  ///< all but its markers
};

/// Reads one entry of `[[forces]]`: name, type and the keys of its type. A new kind of force is one more row
/// in the table of this function's source.
/// @throws support::InputError for a missing, unknown or unfit key; whether the points exist is the vehicle's
/// matter
ForceDescription read_force(const support::TomlTable& table);

/// The element described.
/// @param markers  of its points, in their order
/// @param road     for elements that stand on it; what it points to must outlive the element
std::unique_ptr<ForceElement> make_force(const ForceDescription& force, std::span<const int> markers,
                                         const PlacedRoad& road);

}  // namespace sprung::dynamics
