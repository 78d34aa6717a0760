#include "dynamics/input/body_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "dynamics/element_input/input_values.h"

namespace sprung::dynamics {

namespace {

// Products and squares of values between these do not overflow. No vehicle comes near either limit.
constexpr double kLeast = 1e-30, kMost = 1e30;  // kg, kg·m²
constexpr std::array<std::string_view, 2> kReservedPoints{"origin", "center_of_mass"};

double read_inertia(const support::TomlTable& table, std::string_view key, std::string_view unit) {
  const support::TomlValue value = table.at(key);
  if (value.number(support::non_negative(unit)) == 0.0) return 0.0;
  return value.number({.unit = unit, .at_least = kLeast, .at_most = kMost});
}

bool is_reserved(const std::string& point_name) {
  return std::find(kReservedPoints.begin(), kReservedPoints.end(), point_name) != kReservedPoints.end();
}

PointDescription read_point_on(const std::string& name, const support::TomlValue& value,
                               bool on_superelement) {
  PointDescription point;
  point.name = name;
  point.location = value.location();
  check_name(name, "point", value.location());
  if (is_reserved(name)) throw value.error(fmt::format("has a name that every body has already, '{}'", name));
  if (!value.is_table()) {
    if (on_superelement) {
      throw value.error(
          "must be { node = \"…\", offset = [x, y] }: the body is a superelement, whose points move "
          "with its nodes");
    }
    point.position = read_vector(value, "m");
    return point;
  }
  const support::TomlTable table = value.table();
  if (!on_superelement) {
    throw value.error("must be a position [x, y] [m]: only a body with a superelement has nodes");
  }
  point.node = table.string("node");
  if (const std::optional<support::TomlValue> offset = table.find("offset")) {
    point.position = read_vector(*offset, "m");
  }
  table.reject_unknown_keys();
  return point;
}

BodyDescription read_body(const std::string& name, const support::TomlValue& value) {
  const support::TomlTable table = value.table();
  BodyDescription body;
  body.name = name;
  body.location = value.location();
  check_name(name, "body", value.location());
  if (name == "ground") throw table.error("cannot be a body: 'ground' is the world, which never moves");

  if (const std::optional<support::TomlValue> superelement = table.find("superelement")) {
    body.superelement = superelement->string();
    body.location = superelement->location();
    check_name(body.superelement, "superelement", body.location);
    for (const std::string_view key : {"mass", "inertia"}) {
      if (const std::optional<support::TomlValue> given = table.find(key)) {
        throw given->error("must be left out: the superelement has the body's mass and inertia");
      }
    }
  } else {
    if (!table.has("mass") && !table.has("inertia")) {
      table.find("position"), table.find("angle"), table.find("points");
      table.reject_unknown_keys();
      throw table.error("must have either 'mass' and 'inertia', or a 'superelement'");
    }
    body.mass = read_inertia(table, "mass", "kg");
    body.inertia = read_inertia(table, "inertia", "kg·m²");
    body.mass_location = table.at("mass").location();
    body.inertia_location = table.at("inertia").location();
  }
  body.position = read_vector(table.at("position"), "m");
  if (const std::optional<support::TomlValue> angle = table.find("angle")) {
    body.angle = angle->number(support::any("rad"));
    body.angle_location = angle->location();
  }
  if (const std::optional<support::TomlTable> points = table.find_table("points")) {
    body.points = read_points(*points, !body.superelement.empty());
  }
  table.reject_unknown_keys();
  return body;
}

std::string list_superelements(const std::filesystem::path& folder, const std::string& wanted) {
  std::vector<std::string> names;
  std::error_code error;  // a folder that cannot be listed gives no names
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".h5") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return support::nearest_name_hint(wanted, names);
}

reduce::Superelement read_named(const BodyDescription& body, const std::filesystem::path& folder,
                                SuperelementCache* cache) {
  const std::filesystem::path path = folder / (body.superelement + ".h5");
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw support::InputError(
        body.location,
        fmt::format("body '{}' names superelement '{}', but there is no file {}{}; build it with "
                    "`sprung-reduce build` or give its folder with --superelements",
                    body.name, body.superelement, path.string(),
                    list_superelements(folder, body.superelement)));
  }
  return cache ? cache->read(path) : reduce::read_superelement(path);
}

// A node may be named `origin` only if it is at the origin.
void check_reserved_nodes(const BodyDescription& body, const reduce::Superelement& superelement) {
  for (const reduce::NamedPoint& point : superelement.points) {
    const Eigen::Vector2d at = superelement.node_positions.col(point.node);
    if (!is_reserved(point.name) || (point.name == "origin" && at.norm() == 0.0)) continue;
    throw support::InputError(
        body.location,
        fmt::format("superelement '{}' has a node named '{}' at ({}, {}) m, but every body has a point of "
                    "that name; give the node another in its design",
                    superelement.name, point.name, at.x(), at.y()));
  }
}

void check_nodes(const BodyDescription& body, const reduce::Superelement& superelement) {
  check_reserved_nodes(body, superelement);
  std::vector<std::string> nodes;
  for (const reduce::NamedPoint& point : superelement.points) nodes.push_back(point.name);
  const auto is_node = [&](const std::string& name) {
    return std::find(nodes.begin(), nodes.end(), name) != nodes.end();
  };
  for (const PointDescription& point : body.points) {
    if (!is_node(point.node)) {
      throw support::InputError(point.location,
                                fmt::format("superelement '{}' has no named node '{}'{}", superelement.name,
                                            point.node, support::nearest_name_hint(point.node, nodes)));
    }
    if (is_node(point.name)) {
      throw support::InputError(
          point.location, fmt::format("point '{}' has the name of a node of superelement '{}'", point.name,
                                      superelement.name));
    }
  }
}

}  // namespace

std::vector<PointDescription> read_points(const support::TomlTable& table, bool on_superelement) {
  std::vector<PointDescription> points;
  for (const auto& [name, value] : table.entries())
    points.push_back(read_point_on(name, value, on_superelement));
  return points;
}

std::vector<BodyDescription> read_bodies(const support::TomlTable& table) {
  std::vector<BodyDescription> bodies;
  for (const auto& [name, value] : table.entries()) bodies.push_back(read_body(name, value));
  if (bodies.empty()) throw table.error("must have at least one body");
  return bodies;
}

std::map<std::string, reduce::Superelement> read_superelements(const std::vector<BodyDescription>& bodies,
                                                               const std::filesystem::path& folder,
                                                               SuperelementCache* cache) {
  std::map<std::string, reduce::Superelement> superelements;
  for (const BodyDescription& body : bodies) {
    if (body.superelement.empty()) continue;
    if (!superelements.contains(body.superelement)) {
      superelements.emplace(body.superelement, read_named(body, folder, cache));
    }
    check_nodes(body, superelements.at(body.superelement));
  }
  return superelements;
}

}  // namespace sprung::dynamics
