#include "fem/gmsh/gmsh_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace sprung::fem {

namespace {

using support::InputError;
using support::SourceLocation;

// 0-based number of each node id that is used.
using NodeNumbers = std::unordered_map<std::int64_t, int>;

const GmshContents::Group* find_group(const GmshContents& contents, int dimension, int tag) {
  for (const GmshContents::Group& group : contents.groups) {
    if (group.dimension == dimension && group.tag == tag) return &group;
  }
  return nullptr;
}

std::string describe_line(const GmshContents::Line& line) {
  return fmt::format("line element {} of curve {}, from node {} to node {},", line.id, line.curve, line.first,
                     line.second);
}

// Groups of all elements between the same two nodes, because some formats list an element once for each of
// its groups.
void check_groups(const GmshContents& contents, const SourceLocation& where) {
  std::map<std::pair<std::int64_t, std::int64_t>, int> group_between;
  for (const GmshContents::Line& line : contents.lines) {
    if (line.groups.empty()) {
      throw InputError(where, describe_line(line) + " is in no physical curve, which would name its section");
    }
    const auto [entry, is_new] =
        group_between.emplace(std::minmax(line.first, line.second), line.groups.front());
    const int other = line.groups.size() > 1 ? line.groups.back() : entry->second;
    if (other != line.groups.front()) {
      const auto name = [&](int tag) {
        const GmshContents::Group* group = find_group(contents, 1, tag);
        return group ? group->name : std::string{};
      };
      throw InputError(
          where,
          fmt::format("{} is in two physical curves, {} '{}' and {} '{}'", describe_line(line),
                      std::min(other, line.groups.front()), name(std::min(other, line.groups.front())),
                      std::max(other, line.groups.front()), name(std::max(other, line.groups.front()))));
    }
    const GmshContents::Group* group = find_group(contents, 1, line.groups.front());
    if (!group || group->name.empty()) {
      throw InputError(where, fmt::format("physical curve {} has no name, which would name its section",
                                          line.groups.front()));
    }
  }
}

// Nodes that a line uses; a node that only a point uses is a construction point.
void add_nodes(Mesh& mesh, NodeNumbers& numbers, const GmshContents& contents, const SourceLocation& where) {
  std::set<std::int64_t> used;
  std::set<std::int64_t> with_point;
  for (const GmshContents::Line& line : contents.lines) used.insert({line.first, line.second});
  for (const GmshContents::Point& point : contents.points) with_point.insert(point.node);
  mesh.node_positions.resize(2, static_cast<Eigen::Index>(used.size()));
  const GmshContents::Node* plane = nullptr;
  double extent = 0.0;
  for (const GmshContents::Node& node : contents.nodes) {
    if (used.count(node.id) == 0) {
      if (with_point.count(node.id) == 0) {
        throw InputError(where, fmt::format("node {} belongs to no line element", node.id));
      }
      continue;
    }
    if (!plane) plane = &node;
    const Eigen::Vector3d offset = node.position - plane->position;
    extent = std::max(extent, offset.norm());
    numbers.emplace(node.id, mesh.num_nodes());
    mesh.node_positions.col(mesh.num_nodes()) = node.position.head<2>();
    mesh.node_ids.push_back(node.id);
  }
  for (const GmshContents::Node& node : contents.nodes) {
    if (used.count(node.id) == 0) continue;
    if (std::abs(node.position.z() - plane->position.z()) <= 1e-9 * extent) continue;
    throw InputError(
        where, fmt::format("node {} is at z = {:.9g} and node {} at z = {:.9g}, expected a plane frame, "
                           "z the same everywhere",
                           plane->id, plane->position.z(), node.id, node.position.z()));
  }
}

void add_elements(Mesh& mesh, const NodeNumbers& numbers, const GmshContents& contents) {
  std::set<int> used_groups;
  for (const GmshContents::Line& line : contents.lines) used_groups.insert(line.groups.front());
  std::map<int, int> section_of_group;
  for (const int tag : used_groups) {
    const std::string& name = find_group(contents, 1, tag)->name;
    const auto known = std::find(mesh.section_names.begin(), mesh.section_names.end(), name);
    section_of_group[tag] = static_cast<int>(known - mesh.section_names.begin());
    if (known == mesh.section_names.end()) mesh.section_names.push_back(name);
  }
  for (const GmshContents::Line& line : contents.lines) {
    mesh.elements.push_back({.first = numbers.at(line.first),
                             .second = numbers.at(line.second),
                             .section = section_of_group[line.groups.front()]});
  }
}

void add_named_nodes(Mesh& mesh, const NodeNumbers& numbers, const GmshContents& contents,
                     const SourceLocation& where) {
  for (const GmshContents::Group& group : contents.groups) {
    if (group.dimension != 0 || group.name.empty()) continue;
    std::set<std::int64_t> nodes;
    for (const GmshContents::Point& point : contents.points) {
      if (std::count(point.groups.begin(), point.groups.end(), group.tag) > 0) nodes.insert(point.node);
    }
    if (nodes.empty()) continue;  // a name without a point
    if (nodes.size() > 1 || find_node(mesh, group.name) >= 0) {
      throw InputError(where,
                       fmt::format("physical point '{}' has several points, expected one", group.name));
    }
    const auto number = numbers.find(*nodes.begin());
    if (number == numbers.end()) {
      throw InputError(where, fmt::format("no line passes through physical point '{}'", group.name));
    }
    mesh.named_nodes.push_back({.name = group.name, .node = number->second});
  }
}

template <class Items, class Key>
void sort_by(Items& items, Key key) {
  std::stable_sort(items.begin(), items.end(),
                   [key](const auto& a, const auto& b) { return key(a) < key(b); });
}

}  // namespace

Mesh make_mesh(GmshContents contents, const SourceLocation& where, bool may_have_parts) {
  if (contents.lines.empty()) throw InputError(where, "the mesh has no line elements");
  sort_by(contents.nodes, [](const GmshContents::Node& node) { return node.id; });
  sort_by(contents.lines, [](const GmshContents::Line& line) { return line.id; });
  sort_by(contents.groups, [](const GmshContents::Group& group) { return group.tag; });
  check_groups(contents, where);
  Mesh mesh;
  NodeNumbers numbers;
  add_nodes(mesh, numbers, contents, where);
  add_elements(mesh, numbers, contents);
  add_named_nodes(mesh, numbers, contents, where);
  check_mesh(mesh, where, may_have_parts);
  return mesh;
}

}  // namespace sprung::fem
