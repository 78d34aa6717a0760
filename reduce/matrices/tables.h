#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "reduce/matrices/freedoms.h"

namespace sprung::reduce {

/// Nodes and their places, in ascending order of the numbers.
struct NodeTable {
  std::vector<std::int64_t> ids;
  Eigen::Matrix3Xd positions;  ///< 3×N, in the unit of the file
};

/// Reads a table of freedoms: CSV with the heading `node,direction`, one row for each row of the matrices, in
/// their order. A direction is 1 … 6, or x, y, z, rx, ry, rz, or q of a modal freedom.
/// @throws support::InputError at the place of the fault; a freedom that stands there twice is one
/// Checked by tests/reduce/matrices/matrix_errors_test.py
FreedomList read_freedom_table(const std::filesystem::path& path);

/// Reads the table of freedoms of CalculiX, `.dof`: NODE.DIRECTION in each line.
/// @throws support::InputError at the place of the fault
FreedomList read_calculix_freedoms(const std::filesystem::path& path);

/// Reads a table of nodes: CSV with the heading `node,x,y` or `node,x,y,z`.
/// @throws support::InputError at the place of the fault; a node that stands there twice is one
NodeTable read_node_table(const std::filesystem::path& path);

}  // namespace sprung::reduce
