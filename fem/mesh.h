#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::fem {

/// A planar frame of straight two-node lines that meet at nodes.
struct Mesh {
  struct Element {
    int first = 0;    ///< 0-based node at the element's beginning
    int second = 0;   ///< 0-based node at its end
    int section = 0;  ///< index into section_names
  };
  struct NamedNode {
    std::string name;
    int node = 0;  ///< 0-based
  };

  std::vector<std::int64_t> node_ids;  ///< N, the file's numbers, ascending and > 0
  Eigen::Matrix2Xd node_positions;     ///< 2×N [m]
  std::vector<Element> elements;
  std::vector<std::string> section_names;  ///< each is used by some element
  std::vector<NamedNode> named_nodes;      ///< names are unique; one node may have several

  int num_nodes() const { return static_cast<int>(node_ids.size()); }
  int num_elements() const { return static_cast<int>(elements.size()); }
};

/// @return 0-based node of that name, or -1
int find_node(const Mesh& mesh, std::string_view name);

/// Distance between the ends of an element [m].
double calc_length(const Mesh& mesh, const Mesh::Element& element);

/// Diagonal of the box around all nodes [m].
double calc_extent(const Mesh& mesh);

/// The text by which messages name a node: `node 12 at (0.5, 0.25)`, with its name if it has one.
std::string describe_node(const Mesh& mesh, int node);

/// @throws std::invalid_argument if an array's size or an index is not consistent with the rest (the message
///         names function and item)
void check_mesh_indices(const Mesh& mesh, const char* function);

/// Checks that the mesh is one connected frame: it is 1e-12 … 1e12 m large; it has elements, none shorter
/// than 1e-9 of the frame's extent, no two between the same nodes; every node belongs to an element; no two
/// nodes are at the same position (nearer than 1e-9 of the extent); all elements are connected.
/// @param where  source of the mesh, for the message
/// @param may_have_parts  leaves out whether all elements are connected
/// @throws support::InputError naming the nodes concerned (of the smallest part, if the frame is not
/// connected)
/// @throws std::invalid_argument as check_mesh_indices
/// Checked by tests/fem/mesh_test.cpp
void check_mesh(const Mesh& mesh, const support::SourceLocation& where, bool may_have_parts = false);

/// Checks that elements and `links`, which are pairs of nodes, connect all nodes.
/// @throws support::InputError naming the nodes of the smallest part
void check_connected(const Mesh& mesh, const std::vector<std::pair<int, int>>& links,
                     const support::SourceLocation& where);

}  // namespace sprung::fem
