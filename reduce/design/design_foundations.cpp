#include "reduce/design/design_foundations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "reduce/design/design_frame.h"
#include "reduce/design/known_keys.h"
#include "reduce/design/sizes.h"

namespace sprung::reduce {

namespace {

using support::TomlTable;
using support::TomlValue;

constexpr double kOnTheLine = 1e-6;  // of the frame's extent; a node this near the line is on it
constexpr double kFacing = 1e-6;     // of a line's length, between the places of nodes that face each other

// Nodes on a straight line, in order.
struct NodeLine {
  std::vector<int> nodes;
  std::vector<double> places;  // 0 … 1
  double length = 0.0;         // [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
};

// Each node is joined with the next one. Nodes of an arc, for instance, do not lie on the line between its
// ends.
void require_elements(const fem::Mesh& mesh, const NodeLine& line, const TomlValue& to) {
  std::set<std::pair<int, int>> joined;
  for (const fem::Mesh::Element& element : mesh.elements)
    joined.insert(std::minmax(element.first, element.second));
  for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
    const int first = line.nodes[i], second = line.nodes[i + 1];
    if (joined.count(std::minmax(first, second)) > 0) continue;
    throw to.error(fmt::format(
        "is not reached from the first point along a straight line of elements: none joins {} and {}",
        fem::describe_node(mesh, first), fem::describe_node(mesh, second)));
  }
}

NodeLine find_line(const fem::Mesh& mesh, const TomlValue& from, const TomlValue& to) {
  const Eigen::Vector2d first = mesh.node_positions.col(find_named_node(mesh, from)),
                        last = mesh.node_positions.col(find_named_node(mesh, to));
  NodeLine line;
  line.length = (last - first).norm();
  if (!(line.length > 0.0)) throw to.error("is at the place of the line's first point");
  line.direction = (last - first) / line.length;
  const double tolerance = kOnTheLine * fem::calc_extent(mesh);
  std::vector<std::pair<double, int>> found;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    const Eigen::Vector2d r = mesh.node_positions.col(node) - first;
    const double along = r.dot(line.direction);
    if (along < -tolerance || along > line.length + tolerance) continue;
    if ((r - along * line.direction).norm() <= tolerance) found.emplace_back(along / line.length, node);
  }
  std::sort(found.begin(), found.end());
  for (const auto& [place, node] : found) {
    line.places.push_back(place);
    line.nodes.push_back(node);
  }
  require_elements(mesh, line, to);
  return line;
}

// The length of the line that a node stands for.
double calc_share(const NodeLine& line, std::size_t i) {
  const double before = i > 0 ? line.places[i] - line.places[i - 1] : 0.0;
  const double after = i + 1 < line.places.size() ? line.places[i + 1] - line.places[i] : 0.0;
  return 0.5 * line.length * (before + after);
}

NodeLine find_facing_line(const fem::Mesh& mesh, const TomlValue& ends, const NodeLine& line) {
  const std::vector<TomlValue> names = ends.items();
  if (names.size() != 2)
    throw ends.error(fmt::format("names {} points, expected the 2 ends of a line", names.size()));
  NodeLine other = find_line(mesh, names[0], names[1]);
  // Either end may be named first: springs that cross would all act at one place.
  if (other.direction.dot(line.direction) < 0.0) other = find_line(mesh, names[1], names[0]);
  bool fits = other.nodes.size() == line.nodes.size();
  for (std::size_t i = 0; fits && i < line.nodes.size(); ++i)
    fits = std::abs(other.places[i] - line.places[i]) <= kFacing && other.nodes[i] != line.nodes[i];
  if (fits) return other;
  throw ends.error(
      fmt::format("is a line whose {} nodes do not face the {} of the other line; divide both alike",
                  other.nodes.size(), line.nodes.size()));
}

// A bushing element with the stiffness per length along and across the line, from the node of the base to
// that of the line.
void add_bushing(fem::BeamModel& model, int base, int node, double place, const Eigen::Matrix2d& stiffness,
                 const std::string& name) {
  const Eigen::Vector2d link = model.mesh.node_positions.col(node) - model.mesh.node_positions.col(base);
  const Eigen::Vector2d t = link.normalized();
  const Eigen::Matrix2d R{{t.x(), t.y()}, {-t.y(), t.x()}};
  fem::Bushing bushing{.place = place};
  bushing.stiffness.topLeftCorner<2, 2>() = R * stiffness * R.transpose();
  fem::BeamProperties properties{.axial_rigidity = 1.0, .bending_rigidity = 1.0};  // a bushing has neither
  properties.bushing = bushing;
  model.mesh.elements.push_back(
      {.first = base, .second = node, .section = static_cast<int>(model.mesh.section_names.size())});
  model.mesh.section_names.push_back(name);
  model.sections.push_back(properties);
}

void read_foundation(const TomlTable& table, fem::BeamModel& model) {
  expect_keys(table, {"from", "to", "part", "on", "normal_stiffness", "tangential_stiffness"});
  const NodeLine line = find_line(model.mesh, table.at("from"), table.at("to"));
  const auto part = table.find("part"), on = table.find("on");
  if (part.has_value() == on.has_value())
    throw table.error(
        "expected either 'part', a point of the rigid part, or 'on', the ends of a second line");
  const double normal = read_size(table, "normal_stiffness", "N/m²", kStiffnesses);
  const double tangential = table.has("tangential_stiffness")
                                ? read_size(table, "tangential_stiffness", "N/m²", kStiffnesses)
                                : 0.0;
  const Eigen::Vector2d n(-line.direction.y(), line.direction.x());
  const Eigen::Matrix2d per_length =
      tangential * line.direction * line.direction.transpose() + normal * n * n.transpose();
  std::vector<int> bases;
  if (part) {
    bases.assign(line.nodes.size(), find_named_node(model.mesh, *part));
  } else {
    bases = find_facing_line(model.mesh, *on, line).nodes;
  }
  for (std::size_t i = 0; i < line.nodes.size(); ++i) {
    if (bases[i] == line.nodes[i]) continue;  // the rigid part's own point does not move against it
    const std::string name = fmt::format("{}, node {} of {}", table.key(), i + 1, line.nodes.size());
    add_bushing(model, bases[i], line.nodes[i], part ? 1.0 : 0.5, calc_share(line, i) * per_length, name);
  }
}

}  // namespace

void read_foundations(const TomlTable& root, fem::BeamModel& model) {
  const auto foundations = root.find("foundations");
  if (!foundations) return;
  for (const TomlValue& item : foundations->items()) read_foundation(item.table(), model);
}

}  // namespace sprung::reduce
