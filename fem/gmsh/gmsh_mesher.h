#pragma once

#include <filesystem>

#include "fem/frame_geometry.h"
#include "fem/mesh.h"
#include "tools/support/processes/limited_child.h"

namespace sprung::fem {

// Both functions run the gmsh library in a child process of their own: a file on which gmsh crashes, runs
// without end or asks for all memory is refused like any other. Nothing of gmsh stays in this process. The
// caller should have one thread only (as run_in_limited_child says). Equal input gives an equal mesh.

/// Meshes lines with gmsh's transfinite curves.
///
/// Nodes: the points in their order, then each line's inner nodes from its beginning to its end. Elements:
/// line by line, from its beginning to its end. node_ids are 1 … N; every point is a named node.
///
/// @throws support::InputError as check_frame_geometry and check_mesh do
/// Checked by tests/fem/gmsh/gmsh_mesher_test.cpp
Mesh mesh_lines(const FrameGeometry& geometry);

/// Reads a `.geo` (meshed along its curves, and scaled by its Mesh.ScalingFactor) or a `.msh` file,
/// format 2.2 or 4.1, text or binary.
///
/// Sections are the names of the physical curves, named nodes those of the physical points. Nodes are in
/// ascending order of the file's numbers, elements likewise, each in the direction that its physical curve
/// gives it. Points that no line uses (centres of arcs) are left out. Only straight two-node lines are
/// accepted.
///
/// @param path    ends in .geo or .msh
/// @param limits  of the process in which gmsh reads and meshes the file
/// @param may_have_parts  as in check_mesh
/// @throws support::InputError `path: error: …` for a file that is missing, empty, of another format or
///         version, truncated (fewer nodes or elements than it declares), that gmsh reports as wrong, or on
///         which gmsh crashes or exceeds the limits; for a line in no physical curve, in two, or in one
///         without a name; for elements that are no lines, or of higher order; for z that is not constant;
///         for a physical point of several points, or through which no line passes; for a curve of a
///         `.geo` with more than kMaxElementsPerLine elements; `path:line:column: error: …` for a `.geo` with
///         a statement that writes a file or runs a program; for a `.geo` with options in NAME.geo.opt beside
///         it; and as check_mesh
/// Checked by tests/fem/gmsh/gmsh_mesher_test.cpp
Mesh read_gmsh_file(const std::filesystem::path& path, const support::ChildLimits& limits = {},
                    bool may_have_parts = false);

}  // namespace sprung::fem
