#include "fem/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace sprung::fem {

namespace {

constexpr double kLeastElementLength = 1e-9;  // of the extent; nearer is the same place
// Beyond these, lengths to the fourth power leave the range of a double once they are multiplied with
// stiffnesses.
constexpr double kSmallestExtent = 1e-12, kLargestExtent = 1e12;  // m
constexpr std::size_t kMaxListed = 8;                             // nodes listed in a message

std::string describe_nodes(const Mesh& mesh, const std::vector<int>& nodes) {
  std::string text;
  for (std::size_t i = 0; i < std::min(nodes.size(), kMaxListed); ++i) {
    text += (i == 0 ? "" : ", ") + describe_node(mesh, nodes[i]);
  }
  if (nodes.size() > kMaxListed) text += fmt::format(" and {} more", nodes.size() - kMaxListed);
  return text;
}

void check_positions(const Mesh& mesh, const support::SourceLocation& where) {
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (!mesh.node_positions.col(node).allFinite()) {
      throw support::InputError(where, describe_node(mesh, node) + " has no finite position");
    }
  }
}

void check_extent(double extent, const support::SourceLocation& where) {
  if (extent >= kSmallestExtent && extent <= kLargestExtent) return;
  throw support::InputError(where, fmt::format("the frame is {:.3g} m large, expected {:g} … {:g} m", extent,
                                               kSmallestExtent, kLargestExtent));
}

void check_lengths(const Mesh& mesh, double smallest, const support::SourceLocation& where) {
  for (const Mesh::Element& element : mesh.elements) {
    if (calc_length(mesh, element) > smallest) continue;
    throw support::InputError(
        where,
        fmt::format("element between {} and {} has no length (expected more than {:.3g} m)",
                    describe_node(mesh, element.first), describe_node(mesh, element.second), smallest));
  }
}

void check_duplicates(const Mesh& mesh, const support::SourceLocation& where) {
  std::vector<std::pair<int, int>> ends;
  ends.reserve(mesh.elements.size());
  for (const Mesh::Element& element : mesh.elements)
    ends.emplace_back(std::minmax(element.first, element.second));
  std::sort(ends.begin(), ends.end());
  const auto twice = std::adjacent_find(ends.begin(), ends.end());
  if (twice == ends.end()) return;
  throw support::InputError(where,
                            fmt::format("two elements join {} and {}", describe_node(mesh, twice->first),
                                        describe_node(mesh, twice->second)));
}

// Nodes sorted along a direction that is no direction of usual frames: neighbouring nodes are close in this
// order.
void check_coincident(const Mesh& mesh, double smallest, const support::SourceLocation& where) {
  const Eigen::RowVectorXd along = Eigen::RowVector2d(0.8016, 0.5978).normalized() * mesh.node_positions;
  std::vector<int> order(mesh.node_ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(along[a], a) < std::pair(along[b], b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size() && along[order[j]] - along[order[i]] <= smallest; ++j) {
      const Eigen::Vector2d gap = mesh.node_positions.col(order[i]) - mesh.node_positions.col(order[j]);
      if (gap.norm() > smallest) continue;
      const auto [a, b] = std::minmax(order[i], order[j]);
      throw support::InputError(where, fmt::format("{} and {} are at one place but not joined",
                                                   describe_node(mesh, a), describe_node(mesh, b)));
    }
  }
}

int find_root(std::vector<int>& parent, int node) {
  while (parent[static_cast<std::size_t>(node)] != node) {
    int& up = parent[static_cast<std::size_t>(node)];
    up = parent[static_cast<std::size_t>(up)];
    node = up;
  }
  return node;
}

void check_used(const Mesh& mesh, const support::SourceLocation& where) {
  std::vector<bool> used(mesh.node_ids.size(), false);
  for (const Mesh::Element& element : mesh.elements) {
    used[static_cast<std::size_t>(element.first)] = true;
    used[static_cast<std::size_t>(element.second)] = true;
  }
  std::vector<int> unused;
  for (int node = 0; node < mesh.num_nodes(); ++node) {
    if (!used[static_cast<std::size_t>(node)]) unused.push_back(node);
  }
  if (!unused.empty()) throw support::InputError(where, "no element at " + describe_nodes(mesh, unused));
}

}  // namespace

int find_node(const Mesh& mesh, std::string_view name) {
  for (const Mesh::NamedNode& named : mesh.named_nodes) {
    if (named.name == name) return named.node;
  }
  return -1;
}

double calc_length(const Mesh& mesh, const Mesh::Element& element) {
  return (mesh.node_positions.col(element.second) - mesh.node_positions.col(element.first)).norm();
}

std::string describe_node(const Mesh& mesh, int node) {
  std::string text = fmt::format("node {}", mesh.node_ids[static_cast<std::size_t>(node)]);
  for (const Mesh::NamedNode& named : mesh.named_nodes) {
    if (named.node == node) text += fmt::format(" '{}'", named.name);
  }
  return text +
         fmt::format(" at ({:.6g}, {:.6g})", mesh.node_positions(0, node), mesh.node_positions(1, node));
}

void check_mesh_indices(const Mesh& mesh, const char* function) {
  const auto reject = [function](const std::string& what) {
    throw std::invalid_argument(fmt::format("{}: {}", function, what));
  };
  const int num_nodes = mesh.num_nodes();
  const int num_sections = static_cast<int>(mesh.section_names.size());
  const auto is_node = [num_nodes](int node) { return node >= 0 && node < num_nodes; };
  if (mesh.node_positions.cols() != num_nodes) {
    reject(fmt::format("node_positions has {} columns, expected {}", mesh.node_positions.cols(), num_nodes));
  }
  for (int e = 0; e < mesh.num_elements(); ++e) {
    const auto& [first, second, section] = mesh.elements[static_cast<std::size_t>(e)];
    if (!is_node(first) || !is_node(second)) {
      reject(fmt::format("element {} has nodes {} and {}, expected 0 … {}", e, first, second, num_nodes - 1));
    }
    if (section < 0 || section >= num_sections) {
      reject(fmt::format("element {} has section {}, expected 0 … {}", e, section, num_sections - 1));
    }
  }
  for (const Mesh::NamedNode& named : mesh.named_nodes) {
    if (!is_node(named.node)) {
      reject(fmt::format("'{}' is node {}, expected 0 … {}", named.name, named.node, num_nodes - 1));
    }
  }
}

void check_connected(const Mesh& mesh, const std::vector<std::pair<int, int>>& links,
                     const support::SourceLocation& where) {
  std::vector<int> parent(mesh.node_ids.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Mesh::Element& element : mesh.elements) {
    parent[static_cast<std::size_t>(find_root(parent, element.first))] = find_root(parent, element.second);
  }
  for (const auto& [first, second] : links)
    parent[static_cast<std::size_t>(find_root(parent, first))] = find_root(parent, second);
  std::unordered_map<int, std::vector<int>> parts;
  for (int node = 0; node < mesh.num_nodes(); ++node) parts[find_root(parent, node)].push_back(node);
  if (parts.size() <= 1) return;
  // Among equally small parts, the one that contains the last node.
  const auto smaller = [](const auto& a, const auto& b) {
    return std::pair(a.second.size(), b.second.back()) < std::pair(b.second.size(), a.second.back());
  };
  const auto smallest = std::min_element(parts.begin(), parts.end(), smaller);
  throw support::InputError(
      where, fmt::format("the frame falls into {} parts that no element joins; one of them has {}",
                         parts.size(), describe_nodes(mesh, smallest->second)));
}

void check_mesh(const Mesh& mesh, const support::SourceLocation& where, bool may_have_parts) {
  check_mesh_indices(mesh, "check_mesh");
  if (mesh.elements.empty()) throw support::InputError(where, "the mesh has no line elements");
  check_positions(mesh, where);
  const double extent = calc_extent(mesh), smallest = kLeastElementLength * extent;
  check_extent(extent, where);
  check_used(mesh, where);
  check_lengths(mesh, smallest, where);
  check_duplicates(mesh, where);
  check_coincident(mesh, smallest, where);
  if (!may_have_parts) check_connected(mesh, {}, where);
}

double calc_extent(const Mesh& mesh) {
  return (mesh.node_positions.rowwise().maxCoeff() - mesh.node_positions.rowwise().minCoeff()).norm();
}

}  // namespace sprung::fem
