#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>

namespace sprung::fem {

/// The declarations of a gmsh mesh file, read without gmsh, as a check of what gmsh has read.
struct MshDeclaration {
  std::string version;            ///< "2.2" or "4.1"
  std::int64_t num_nodes = 0;     ///< declared in $Nodes
  std::int64_t num_elements = 0;  ///< declared in $Elements

  /// Format 2.2 only: the physical group of each point and line element by its number, 0 for none. gmsh
  /// itself reports groups by elementary entity, which mixes elements of one entity that are in different
  /// groups.
  std::unordered_map<std::int64_t, int> element_groups = {};
};

/// Reads the header, the numbers of nodes and elements and (2.2) the elements' groups of a `.msh` file.
///
/// @throws support::InputError `path: error: …` if the file is missing, empty, not in format 2.2 or 4.1, a
///         section has no end (truncated), or a number in it cannot be
/// Source: [gmsh 4.8], chapter "File formats" — checked by tests/fem/gmsh/msh_file_test.cpp
MshDeclaration read_msh_declaration(const std::filesystem::path& path);

/// The same of a file's bytes. @param name  of the file, for messages
MshDeclaration parse_msh_declaration(std::string_view file, const std::string& name);

}  // namespace sprung::fem
