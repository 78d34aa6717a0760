#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh.h"
#include "reduce/design/design_sections.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// A design's mesh and the files it was made from.
struct DesignFrame {
  fem::Mesh mesh;                        ///< with all named points of the design
  std::vector<std::string> input_names;  ///< mesh files, as the design names them
  std::vector<std::string> input_hashes;
};

/// Makes the mesh of a design: from `[points]` and `[[lines]]`, or from the gmsh file that `mesh` names;
/// `[points]` that no line begins or ends at give names to nodes that are there.
///
/// @param folder  the design file's, which `mesh` is relative to
/// @throws support::InputError
/// Checked by tests/reduce/design/design_test.cpp
DesignFrame read_design_frame(const support::TomlTable& root, const std::filesystem::path& folder,
                              const Sections& sections);

/// Gives the names of `[points]` to the nodes at their places.
/// @throws support::InputError at a point where there is no node
void name_nodes(const support::TomlTable& root, fem::Mesh& mesh);

/// A node of the mesh by the name that a key gives.
/// @throws support::InputError at the value if the mesh has no such name (nearest one named)
int find_named_node(const fem::Mesh& mesh, const support::TomlValue& name);

}  // namespace sprung::reduce
