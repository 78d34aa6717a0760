#include "dynamics/element_input/force_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "dynamics/element_input/air_spring_input.h"
#include "dynamics/element_input/characteristic_input.h"
#include "dynamics/element_input/input_values.h"
#include "dynamics/element_input/suspension_input.h"
#include "dynamics/element_input/time_function_input.h"
#include "dynamics/forces/distributed_tyre.h"
#include "dynamics/forces/point_contact_tyre.h"

namespace sprung::dynamics {

namespace {

// Reads the keys of one type of force into a description that has its name and location already.
using ForceReader = void (*)(const support::TomlTable& table, ForceDescription& force,
                             HistoryFiles& histories);

// Reads the spring with its stops, and the deflections where these begin.
template <typename Parameters>
void read_spring_with_stops(const support::TomlTable& table, const LawUnits& units, Parameters& parameters) {
  const std::optional<support::TomlTable> law = table.find_table("spring");
  if (law) parameters.spring = read_spring(*law, units);
  const std::optional<support::TomlTable> compression = table.find_table("compression_stop");
  const std::optional<support::TomlTable> rebound = table.find_table("rebound_stop");
  std::optional<double>& begins = parameters.compression_stop;
  if (compression) begins = read_stop(*compression, false, parameters.spring, units);
  if (rebound) {
    const support::TomlValue at = rebound->at("deflection");
    const double deflection = at.number(support::any(units.deflection));
    if (begins && !(deflection < *begins)) {
      throw at.error(fmt::format("must lie below the compression stop's {} {}, got {} {}", *begins,
                                 units.deflection, deflection, units.deflection));
    }
    parameters.rebound_stop = read_stop(*rebound, true, parameters.spring, units);
  }
}

// Reads spring, stops and damper, of which there must be at least one.
template <typename Parameters>
void read_laws(const support::TomlTable& table, const LawUnits& units, Parameters& parameters) {
  parameters.multiplicity = table.number_or("multiplicity", 1.0, kMultiplicity);
  read_spring_with_stops(table, units, parameters);
  const std::optional<support::TomlTable> damper = table.find_table("damper");
  if (damper) parameters.damper = read_damper(*damper, units);
  if (!damper && !table.has("spring") && !table.has("compression_stop") && !table.has("rebound_stop")) {
    table.reject_unknown_keys();
    throw table.error("must have a 'spring', a stop or a 'damper'");
  }
}

StaticLength read_static_length(const support::TomlTable& table) {
  static const std::array<std::string, 1> kAsDrawn{"as-drawn"};
  const support::TomlValue value = table.at("static");
  StaticLength wanted{.key = "free_length.static", .length = {}, .location = value.location()};
  if (value.is_number()) {
    wanted.length = value.number(support::positive("m"));
  } else {
    value.one_of(kAsDrawn);
  }
  table.reject_unknown_keys();
  return wanted;
}

void read_spring_damper(const support::TomlTable& table, ForceDescription& force,
                        HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  force.along_line = true;
  SpringDamper::Parameters parameters;
  parameters.free_length = read_free_length(table, force);
  read_laws(table, kTranslation, parameters);
  if (force.static_length && !table.has("spring")) {
    table.reject_unknown_keys();
    throw table.at("free_length").error("can follow from the static length only where there is a 'spring'");
  }
  force.parameters = std::move(parameters);
}

void read_rotational_spring_damper(const support::TomlTable& table, ForceDescription& force,
                                   HistoryFiles& /*histories*/) {
  force.points = {read_point(table.at("a")), read_point(table.at("b"))};
  RotationalSpringDamper::Parameters parameters;
  parameters.free_angle = table.number_or("free_angle", 0.0, support::any("rad"));
  read_laws(table, kRotation, parameters);
  force.parameters = std::move(parameters);
}

void read_applied(const support::TomlTable& table, ForceDescription& force, HistoryFiles& histories) {
  static const std::array<std::string, 2> kAxes{"world", "following"};
  force.points = {read_point(table.at("point"))};
  AppliedForce::Parameters parameters;
  if (const std::optional<support::TomlValue> axes = table.find("axes")) {
    parameters.axes =
        axes->one_of(kAxes) == "world" ? AppliedForce::Axes::kWorld : AppliedForce::Axes::kFollowing;
  }
  const std::optional<support::TomlValue> components = table.find("force");
  if (components) {
    if (!components->is_array() || components->items().size() != 2) {
      throw components->error("must be [x, y], each a number [N] or a function of time");
    }
    parameters.force_x = read_time_function(components->items()[0], "N", TimeFunctionUse::kForce, histories);
    parameters.force_y = read_time_function(components->items()[1], "N", TimeFunctionUse::kForce, histories);
  }
  const std::optional<support::TomlValue> torque = table.find("torque");
  if (torque) parameters.torque = read_time_function(*torque, "N·m", TimeFunctionUse::kForce, histories);
  if (!components && !torque) {
    table.reject_unknown_keys();
    throw table.error("must have a 'force' or a 'torque'");
  }
  force.parameters = std::move(parameters);
}

// Reads the parameters that both kinds of tyre share; a distributed tyre does not use one_sided.
Tyre::Parameters read_tyre_laws(const support::TomlTable& table) {
  Tyre::Parameters parameters;
  parameters.radius = table.number("radius", support::positive("m"));
  parameters.multiplicity = table.number_or("multiplicity", 1.0, kMultiplicity);
  parameters.damping = table.number_or("damping", 0.0, support::non_negative("N·s/m"));
  parameters.one_sided = table.boolean_or("one_sided", true);
  const support::TomlTable spring = table.at("spring").table();
  parameters.spring = read_spring(spring);
  if (parameters.spring.value(0.0) != 0.0) {
    throw spring.error(
        fmt::format("of a tyre must give no force at penetration 0, got {} N", parameters.spring.value(0.0)));
  }
  if (!(parameters.spring.value(parameters.radius) > 0.0)) {
    throw spring.error(fmt::format("of a tyre must push at a penetration of its radius {} m, got {} N",
                                   parameters.radius, parameters.spring.value(parameters.radius)));
  }
  if (!parameters.one_sided && !(parameters.spring.value(-parameters.radius) < 0.0)) {
    throw spring.error(fmt::format(
        "of a tyre that is not one-sided must pull at a penetration of -{} m, got {} N; use odd powers",
        parameters.radius, parameters.spring.value(-parameters.radius)));
  }
  return parameters;
}

void read_tyre(const support::TomlTable& table, ForceDescription& force, HistoryFiles& /*histories*/) {
  static const std::array<std::string, 2> kContacts{"point", "distributed"};
  force.points = {read_point(table.at("wheel"))};
  force.on_road = true;
  const std::optional<support::TomlValue> contact = table.find("contact");
  TyreDescription tyre{.is_distributed = contact && contact->one_of(kContacts) == "distributed",
                       .parameters = read_tyre_laws(table)};
  if (tyre.is_distributed && !tyre.parameters.one_sided) {
    throw table.at("one_sided").error("must be true of a tyre with distributed contact, which cannot pull");
  }
  force.parameters = std::move(tyre);
}

const std::vector<std::pair<std::string, ForceReader>>& force_readers() {
  static const std::vector<std::pair<std::string, ForceReader>> readers{
      {"spring-damper", read_spring_damper},
      {"rotational-spring-damper", read_rotational_spring_damper},
      {"applied", read_applied},
      {"tyre", read_tyre},
      {"hydraulic-stop", read_hydraulic_stop},
      {"bushing", read_bushing},
      {"leaf-spring", read_leaf_spring},
      {"air-spring", read_air_spring},
  };
  return readers;
}

// Each makes the element of one kind, with its markers.
std::unique_ptr<ForceElement> place(const std::string& name, SpringDamper::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker_a = markers[0];
  parameters.marker_b = markers[1];
  return std::make_unique<SpringDamper>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, RotationalSpringDamper::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker_a = markers[0];
  parameters.marker_b = markers[1];
  return std::make_unique<RotationalSpringDamper>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, AppliedForce::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker = markers[0];
  return std::make_unique<AppliedForce>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, TyreDescription tyre,
                                    std::span<const int> markers, const PlacedRoad& road) {
  tyre.parameters.marker = markers[0];
  if (tyre.is_distributed) return std::make_unique<DistributedTyre>(name, std::move(tyre.parameters), road);
  return std::make_unique<PointContactTyre>(name, std::move(tyre.parameters), road);
}

std::unique_ptr<ForceElement> place(const std::string& name, HydraulicStop::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker_a = markers[0];
  parameters.marker_b = markers[1];
  return std::make_unique<HydraulicStop>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, Bushing::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker_a = markers[0];
  parameters.marker_b = markers[1];
  return std::make_unique<Bushing>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, LeafSpring::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  parameters.marker_a = markers[0];
  parameters.marker_b = markers[1];
  return std::make_unique<LeafSpring>(name, std::move(parameters));
}

std::unique_ptr<ForceElement> place(const std::string& name, AirSpring::Parameters parameters,
                                    std::span<const int> markers, const PlacedRoad& /*road*/) {
  std::copy(markers.begin(), markers.end(), parameters.markers.begin());
  return std::make_unique<AirSpring>(name, std::move(parameters));
}

}  // namespace

double read_free_length(const support::TomlTable& table, ForceDescription& force) {
  const support::TomlValue free_length = table.at("free_length");
  if (!free_length.is_table()) return free_length.number(support::positive("m"));
  force.static_length = read_static_length(free_length.table());
  return force.static_length->length.value_or(1.0);  // until the balance is known
}

ForceDescription read_force(const support::TomlTable& table, HistoryFiles& histories) {
  ForceDescription force;
  force.name = table.string("name");
  force.location = table.at("name").location();
  check_name(force.name, "force", force.location);

  std::vector<std::string> kinds;
  for (const auto& [kind, reader] : force_readers()) kinds.push_back(kind);
  force.kind = table.at("type").one_of(kinds);
  const auto found = std::find(kinds.begin(), kinds.end(), force.kind);
  force_readers()[static_cast<std::size_t>(found - kinds.begin())].second(table, force, histories);
  table.reject_unknown_keys();
  return force;
}

std::unique_ptr<ForceElement> make_force(const ForceDescription& force, std::span<const int> markers,
                                         const PlacedRoad& road) {
  return std::visit([&](const auto& parameters) { return place(force.name, parameters, markers, road); },
                    force.parameters);
}

}  // namespace sprung::dynamics
