#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "dynamics/element_input/history_input.h"
#include "dynamics/element_input/point_reference.h"
#include "dynamics/forces/air_spring.h"
#include "dynamics/forces/applied_force.h"
#include "dynamics/forces/bushing.h"
#include "dynamics/forces/hydraulic_stop.h"
#include "dynamics/forces/leaf_spring.h"
#include "dynamics/forces/rotational_spring_damper.h"
#include "dynamics/forces/spring_damper.h"
#include "dynamics/forces/tyre.h"
#include "dynamics/road/road.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Parameters of a tyre of either kind.
struct TyreDescription {
  bool is_distributed = false;  ///< touches the road along a length of it
  Tyre::Parameters parameters;
};

/// Parameters of a force element of any kind.
using ForceParameters = std::variant<SpringDamper::Parameters, RotationalSpringDamper::Parameters,
                                     AppliedForce::Parameters, TyreDescription, HydraulicStop::Parameters,
                                     Bushing::Parameters, LeafSpring::Parameters, AirSpring::Parameters>;

/// A length in static equilibrium, from which the free length of a spring-damper follows, or the pressure of
/// an air spring (dynamics/preparation/static_lengths.h).
struct StaticLength {
  std::string key;               ///< that asks for it: "free_length.static"
  std::optional<double> length;  ///< [m]; none: the distance of the points as the vehicle file has them
  support::SourceLocation location;
};

/// A force element as described in the vehicle file.
struct ForceDescription {
  std::string name;
  std::string kind;                    ///< the file's `type`
  std::vector<PointReference> points;  ///< where it acts
  bool along_line = false;  ///< acts along the line between its two points, which must not coincide
  bool on_road = false;     ///< a tyre: its first point is the wheel's centre
  support::SourceLocation location;
  ForceParameters parameters;                      ///< all but its markers
  std::optional<StaticLength> static_length = {};  ///< in place of its free length, or of its pressure
};

/// Reads the key `free_length`: a number, or a table that gives the static length.
/// @return the free length [m]; of a static length one that has to be found
double read_free_length(const support::TomlTable& table, ForceDescription& force);

/// Reads one entry of `[[forces]]`: name, type and the keys of its type, by the table `force_readers`. It
/// does not check that the points exist; `read_vehicle` does.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
/// Checked by tests/dynamics/element_input/force_input_test.cpp
ForceDescription read_force(const support::TomlTable& table, HistoryFiles& histories);

/// Makes the element of a description.
/// @param markers  of its points, in the order of force.points
/// @param road     for elements that stand on it; its road must outlive the element
std::unique_ptr<ForceElement> make_force(const ForceDescription& force, std::span<const int> markers,
                                         const PlacedRoad& road);

}  // namespace sprung::dynamics
