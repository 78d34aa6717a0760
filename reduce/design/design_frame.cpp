#include "reduce/design/design_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "fem/gmsh/geo_script.h"
#include "fem/gmsh/gmsh_mesher.h"
#include "reduce/design/design.h"
#include "reduce/design/design_couplings.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/sizes.h"
#include "tools/support/files/read_text_file.h"

namespace sprung::reduce {

namespace {

using support::InputError;
using support::TomlTable;
using support::TomlValue;
using Points = std::vector<fem::FrameGeometry::Point>;

constexpr double kSamePlace = 1e-6;  // of the frame's extent; a point this near a node names it

Eigen::Vector2d read_place(const TomlValue& value) {
  const std::vector<double> place =
      value.numbers({.unit = "m", .at_least = -kLengths.largest, .at_most = kLengths.largest}, 2);
  return {place[0], place[1]};
}

Points read_points(const TomlTable& root) {
  Points points;
  const std::optional<TomlTable> table = root.find_table("points");
  if (!table) return points;
  for (const auto& [name, value] : table->entries()) {
    points.push_back({.name = name, .position = read_place(value), .where = value.location()});
  }
  return points;
}

// The place through which a line goes as an arc.
std::optional<Eigen::Vector2d> find_via(const TomlTable& line) {
  const auto via = line.find("via");
  return via ? std::optional(read_place(*via)) : std::nullopt;
}

// The points a line passes through, in order.
std::vector<TomlValue> read_corners(const TomlTable& table) {
  const auto through = table.find("through");
  const auto from = table.find("from"), to = table.find("to");
  if (!through) return {table.at("from"), table.at("to")};
  if (from || to) throw table.error("has 'through' beside 'from' or 'to'; give either");
  if (const auto via = table.find("via"))
    throw via->error("stands beside 'through'; an arc has 'from' and 'to'");
  std::vector<TomlValue> corners = through->items();
  if (corners.size() < 2)
    throw through->error(fmt::format("names {} points, expected at least 2", corners.size()));
  return corners;
}

// Elements of each of a line's segments: one number for all, or a list.
std::vector<int> read_element_numbers(const TomlTable& table, std::size_t num_segments) {
  const TomlValue elements = table.at("elements");
  if (!elements.is_array()) {
    return std::vector<int>(num_segments, static_cast<int>(elements.integer(1, kMostElements)));
  }
  std::vector<int> numbers;
  for (const TomlValue& item : elements.items())
    numbers.push_back(static_cast<int>(item.integer(1, kMostElements)));
  if (numbers.size() == num_segments) return numbers;
  throw elements.error(
      fmt::format("has {} numbers for the line's {} segments", numbers.size(), num_segments));
}

std::string read_point_name(const TomlValue& value, const std::vector<std::string>& point_names) {
  const std::string& name = value.string();
  if (std::find(point_names.begin(), point_names.end(), name) != point_names.end()) return name;
  throw value.error(fmt::format("names the point '{}', which is not defined{}", name,
                                support::nearest_name_hint(name, point_names)));
}

void check_section(const TomlValue& name, const Sections& sections) {
  if (sections.count(name.string()) > 0) return;
  std::vector<std::string> names;
  for (const auto& [known, properties] : sections) names.push_back(known);
  throw name.error(fmt::format("names the section '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), names)));
}

void read_line(const TomlTable& table, const Sections& sections, const std::vector<std::string>& point_names,
               fem::FrameGeometry& geometry) {
  expect_keys(table, {"from", "to", "via", "through", "section", "elements"});
  const std::vector<TomlValue> corners = read_corners(table);
  const std::optional<TaperedLine> taper = find_taper(table);
  if (!taper) check_section(table.at("section"), sections);
  const std::vector<int> num_elements = read_element_numbers(table, corners.size() - 1);
  const std::optional<Eigen::Vector2d> via = find_via(table);
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    fem::FrameGeometry::Line line{.name = {},
                                  .from = read_point_name(corners[i], point_names),
                                  .to = read_point_name(corners[i + 1], point_names),
                                  .section = taper ? taper->section_name(0) : table.at("section").string(),
                                  .num_elements = num_elements[i],
                                  .via = via,
                                  .where = corners[i].location()};
    line.name = fmt::format("{}: {} – {}", table.key(), line.from, line.to);
    geometry.lines.push_back(std::move(line));
  }
}

void read_spring_line(const TomlTable& table, const std::vector<std::string>& point_names,
                      fem::FrameGeometry& geometry) {
  const TomlValue from = table.at("from"), to = table.at("to");
  fem::FrameGeometry::Line line{.name = {},
                                .from = read_point_name(from, point_names),
                                .to = read_point_name(to, point_names),
                                .section = name_spring_section(table),
                                .num_elements = 1,
                                .where = from.location()};
  line.name = fmt::format("{}: {} – {}", table.key(), line.from, line.to);
  geometry.lines.push_back(std::move(line));
}

double calc_distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                                const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (a + t * along - p).norm();
}

double calc_distance_to_frame(const fem::Mesh& mesh, const Eigen::Vector2d& position) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const fem::Mesh::Element& element : mesh.elements) {
    nearest = std::min(nearest, calc_distance_to_segment(position, mesh.node_positions.col(element.first),
                                                         mesh.node_positions.col(element.second)));
  }
  return nearest;
}

// Gives a point's name to the node at its place.
void name_node(fem::Mesh& mesh, const fem::FrameGeometry::Point& point) {
  const double tolerance = kSamePlace * fem::calc_extent(mesh);
  Eigen::Index node = 0;
  const double distance = (mesh.node_positions.colwise() - point.position).colwise().norm().minCoeff(&node);
  if (distance <= tolerance) {
    mesh.named_nodes.push_back({.name = point.name, .node = static_cast<int>(node)});
    return;
  }
  const double off_frame = calc_distance_to_frame(mesh, point.position);
  const std::string fault =
      mesh.elements.empty() ? fmt::format("is {:.6g} m away from the nearest node", distance)
      : off_frame <= tolerance
          ? fmt::format("lies on a line, but {:.6g} m from its nearest node; let the line pass 'through' it",
                        distance)
          : fmt::format("lies on no line: the nearest is {:.6g} m away", off_frame);
  throw InputError(point.where, fmt::format("point '{}' at ({:.6g}, {:.6g}) {}", point.name,
                                            point.position.x(), point.position.y(), fault));
}

// A point that follows others may be a node of its own, which no line passes through.
void add_follower_node(fem::Mesh& mesh, const fem::FrameGeometry::Point& point) {
  const double tolerance = kSamePlace * fem::calc_extent(mesh);
  Eigen::Index node = 0;
  if ((mesh.node_positions.colwise() - point.position).colwise().norm().minCoeff(&node) > tolerance) {
    node = mesh.node_positions.cols();
    mesh.node_positions.conservativeResize(Eigen::NoChange, node + 1);
    mesh.node_positions.col(node) = point.position;
    mesh.node_ids.push_back(mesh.node_ids.back() + 1);
  }
  mesh.named_nodes.push_back({.name = point.name, .node = static_cast<int>(node)});
}

void name_points(const TomlTable& root, const Points& points, fem::Mesh& mesh) {
  const std::set<std::string> followers = list_followers(root);
  for (const fem::FrameGeometry::Point& point : points) {
    if (followers.count(point.name) > 0) {
      add_follower_node(mesh, point);
    } else {
      name_node(mesh, point);
    }
  }
}

// Gives each element of tapered lines its section. Elements stand line by line.
void assign_tapered_sections(const TomlTable& root, fem::Mesh& mesh) {
  std::map<std::string, int> known;
  for (const std::string& name : mesh.section_names) known.emplace(name, static_cast<int>(known.size()));
  std::size_t element = 0;
  for (const TomlValue& item : root.at("lines").items()) {
    const TomlTable line = item.table();
    const std::optional<TaperedLine> taper = find_taper(line);
    if (!taper) {
      for (const int count : read_element_numbers(line, read_corners(line).size() - 1))
        element += static_cast<std::size_t>(count);
      continue;
    }
    for (int i = 0; i < taper->num_elements; ++i, ++element) {
      const auto [found, is_new] =
          known.emplace(taper->section_name(i), static_cast<int>(mesh.section_names.size()));
      if (is_new) mesh.section_names.push_back(found->first);
      mesh.elements[element].section = found->second;
    }
  }
}

// Whether a design has tables that may join parts of its frame beside lines.
bool has_joining_tables(const TomlTable& root) {
  return root.has("rigid_offsets") || root.has("averages") || root.has("foundations");
}

DesignFrame read_lines(const TomlTable& root, const Points& points, const Sections& sections) {
  fem::FrameGeometry geometry;
  std::vector<std::string> point_names;
  for (const fem::FrameGeometry::Point& point : points) point_names.push_back(point.name);
  for (const TomlValue& line : root.at("lines").items())
    read_line(line.table(), sections, point_names, geometry);
  if (const auto springs = root.find("springs")) {
    for (const TomlValue& spring : springs->items()) read_spring_line(spring.table(), point_names, geometry);
  }
  geometry.may_have_parts = has_joining_tables(root);
  if (geometry.lines.empty()) throw root.at("lines").error("is empty, expected at least one line");
  std::set<std::string> corners;
  for (const fem::FrameGeometry::Line& line : geometry.lines) corners.insert({line.from, line.to});
  Points other;
  for (const fem::FrameGeometry::Point& point : points) {
    (corners.count(point.name) > 0 ? geometry.points : other).push_back(point);
  }
  DesignFrame frame{.mesh = fem::mesh_lines(geometry), .input_names = {}, .input_hashes = {}};
  assign_tapered_sections(root, frame.mesh);
  name_points(root, other, frame.mesh);
  return frame;
}

// A spring between nodes of a mesh file.
void add_spring_element(const TomlTable& spring, fem::Mesh& mesh) {
  const TomlValue from = spring.at("from"), to = spring.at("to");
  mesh.elements.push_back({.first = find_named_node(mesh, from),
                           .second = find_named_node(mesh, to),
                           .section = static_cast<int>(mesh.section_names.size())});
  mesh.section_names.push_back(name_spring_section(spring));
}

// A file that pulls in others would change without a sign of it: hashes are kept of the files a design names.
void check_self_contained(const std::filesystem::path& path) {
  if (path.extension() != ".geo") return;
  const std::string text = support::read_text_file(path);
  static constexpr std::array<std::string_view, 8> kReading = {
      "Include",  "Merge", "MergeWithBoundingBox", "Open", "ShapeFromFile", "ListFromFile",
      "FileName", "GetEnv"};
  if (const std::optional<fem::GeoStatement> found = fem::find_geo_statement(text, kReading)) {
    throw InputError(
        {.path = path.string(), .line = found->line, .column = found->column},
        fmt::format("'{}' reads another file or the environment; put everything in one file, so that a "
                    "change of it is noticed",
                    found->word));
  }
}

DesignFrame read_mesh(const TomlTable& root, const TomlValue& name, const Points& points,
                      const std::filesystem::path& folder, const Sections& sections) {
  const std::filesystem::path path = folder / name.string();
  DesignFrame frame;
  frame.input_names = {name.string()};
  frame.input_hashes = {calc_file_hash(path)};
  check_self_contained(path);
  frame.mesh = fem::read_gmsh_file(path, {}, has_joining_tables(root) || root.has("springs"));
  std::vector<std::string> names;
  for (const auto& [known, properties] : sections) names.push_back(known);
  for (const std::string& section : frame.mesh.section_names) {
    if (sections.count(section) > 0) continue;
    throw InputError({.path = path.string()},
                     fmt::format("physical curve '{}' is no section of the design{}", section,
                                 support::nearest_name_hint(section, names)));
  }
  for (const fem::FrameGeometry::Point& point : points) {
    if (fem::find_node(frame.mesh, point.name) >= 0) {
      throw InputError(point.where,
                       fmt::format("point '{}' is named in '{}' already", point.name, name.string()));
    }
  }
  name_points(root, points, frame.mesh);
  if (const auto springs = root.find("springs")) {
    for (const TomlValue& spring : springs->items()) add_spring_element(spring.table(), frame.mesh);
  }
  return frame;
}

}  // namespace

DesignFrame read_design_frame(const TomlTable& root, const std::filesystem::path& folder,
                              const Sections& sections) {
  const Points points = read_points(root);
  const auto mesh = root.find("mesh");
  if (!mesh) return read_lines(root, points, sections);
  if (const auto lines = root.find("lines")) throw lines->error("stands beside 'mesh'; give either");
  if (!support::is_regular_file(folder / mesh->string()))
    throw mesh->error(
        fmt::format("must name a file, found none at '{}'", (folder / mesh->string()).string()));
  return read_mesh(root, *mesh, points, folder, sections);
}

void name_nodes(const TomlTable& root, fem::Mesh& mesh) {
  for (const fem::FrameGeometry::Point& point : read_points(root)) name_node(mesh, point);
}

int find_named_node(const fem::Mesh& mesh, const TomlValue& name) {
  const int node = fem::find_node(mesh, name.string());
  if (node >= 0) return node;
  std::vector<std::string> names;
  for (const fem::Mesh::NamedNode& named : mesh.named_nodes) names.push_back(named.name);
  throw name.error(fmt::format("names the point '{}', which is not defined{}", name.string(),
                               support::nearest_name_hint(name.string(), names)));
}

}  // namespace sprung::reduce
