#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "dynamics/road/road.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The road of a run file, `[road]`.
struct RoadDescription {
  std::string shape = "flat";  ///< "flat", one of bump_shape_names(), or "table"
  double start = 0.0;          ///< where it begins [m]
  double length = 0.0;         ///< of a bump, > 0 [m]
  double height = 0.0;         ///< of a bump [m]
  std::filesystem::path file;  ///< of a table
  support::SourceLocation file_location;
  support::SourceLocation location;
};

/// Reads `[road]`: shape and the keys of that shape.
/// @param folder  the folder that the key `file` is relative to
/// @throws support::InputError at the first key or value that is wrong
/// Checked by tests/dynamics/input/road_input_test.cpp
RoadDescription read_road(const support::TomlTable& table, const std::filesystem::path& folder);

/// Makes the road of a description. For a table it reads the file: two columns, distance [m] and height [m],
/// separated by blanks or a comma, distances ascending, first height 0; `#` begins a comment.
/// @throws support::InputError at the line and column of the fault in the table's file
/// Checked by tests/dynamics/input/road_input_test.cpp
std::unique_ptr<Road> make_road(const RoadDescription& description);

}  // namespace sprung::dynamics
