#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace sprung::fem {

/// A statement of a script in gmsh's language.
struct GeoStatement {
  std::string_view word;  ///< the word that it begins with, in the script's text
  int line = 0;           ///< 1-based
  int column = 0;         ///< 1-based
};

/// The first statement that begins with one of the words and has an argument: `Save "x.msh";`, and neither
/// the option `Print.Background` nor what stands in a comment or in a string. Functions and the FileName of a
/// mesh size field are found likewise.
/// @param words  of statements, such as `Save`
std::optional<GeoStatement> find_geo_statement(std::string_view text,
                                               std::span<const std::string_view> words);

/// The first statement that writes a file or runs a program: Save, Print, SystemCall, Plugin, Printf into a
/// file, ….
/// Checked by tests/fem/gmsh/geo_script_test.cpp
std::optional<GeoStatement> find_writing_statement(std::string_view text);

/// The second statement of a last line that does not end: gmsh 4.8 reads the first one only.
/// Checked by tests/fem/gmsh/geo_script_test.cpp
std::optional<GeoStatement> find_dropped_statement(std::string_view text);

}  // namespace sprung::fem
