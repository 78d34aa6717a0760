#pragma once

#include <filesystem>

#include "fem/frame_geometry.h"
#include "fem/mesh.h"

namespace sprung::fem {

// Both functions use the gmsh library, which is not thread-safe: one call at a time in a process. They leave
// gmsh finalised and the process's locale as it was, print nothing, read no user options and install no
// signal handlers. Equal input gives an equal mesh.

/// Meshes lines with gmsh's transfinite curves.
///
/// Nodes: the points in their order, then each line's inner nodes from its beginning to its end. Elements:
/// line by line, from its beginning to its end. node_ids are 1 … N; every point is a named node.
///
/// @throws support::InputError as check_frame_geometry and check_mesh do
/// Checked by tests/fem/gmsh_mesher_test.cpp
Mesh mesh_lines(const FrameGeometry& geometry);

/// Reads a `.geo` (meshed along its curves) or a `.msh` file, format 2.2 or 4.1, text or binary.
///
/// Sections are the names of the physical curves, named nodes those of the physical points. Nodes are in
/// ascending order of the file's numbers, elements likewise, each in the direction that its physical curve
/// gives it. Points that no line uses (centres of arcs) are left out. Only straight two-node lines are
/// accepted.
///
/// @param path  ends in .geo or .msh
/// @throws support::InputError `path: error: …` for a file that is missing, empty, of another format or
///         version, truncated (fewer nodes or elements than it declares), or that gmsh reports as wrong; for
///         a line in no physical curve, in two, or in one without a name; for elements that are no lines, or
///         of higher order; for z that is not constant; for a physical point of several points, or through
///         which no line passes; and as check_mesh
/// Checked by tests/fem/gmsh_mesher_test.cpp
Mesh read_gmsh_file(const std::filesystem::path& path);

}  // namespace sprung::fem
