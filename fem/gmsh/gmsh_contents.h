#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "fem/mesh.h"
#include "tools/support/errors/input_error.h"

namespace sprung::fem {

/// The contents of gmsh after meshing or reading, as plain arrays: nodes, points, two-node lines, physical
/// groups.
struct GmshContents {
  struct Node {
    std::int64_t id = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  };
  struct Point {
    std::int64_t id = 0;      ///< number of the point element
    std::int64_t node = 0;    ///< id of its node
    std::vector<int> groups;  ///< tags of physical points
  };
  struct Line {
    std::int64_t id = 0;     ///< number of the line element
    std::int64_t first = 0;  ///< ids of its nodes
    std::int64_t second = 0;
    int curve = 0;            ///< tag of the curve it lies on
    std::vector<int> groups;  ///< tags of physical curves
  };
  struct Group {
    int dimension = 0;
    int tag = 0;
    std::string name;  ///< may be empty
  };

  std::vector<Node> nodes;
  std::vector<Point> points;
  std::vector<Line> lines;
  std::vector<Group> groups;
};

/// Makes the mesh: nodes used by lines in ascending order of id, elements in ascending order of id, sections
/// and named nodes in the order of their groups' tags.
///
/// @param where  for messages
/// @throws support::InputError for lines in no physical curve, in two, or in one without a name; for z not
///         constant; for a physical point of several points, or through which no line passes; for a node with
///         neither line nor point; and as check_mesh
/// Checked by tests/fem/gmsh/gmsh_contents_test.cpp
Mesh make_mesh(GmshContents contents, const support::SourceLocation& where, bool may_have_parts = false);

}  // namespace sprung::fem
