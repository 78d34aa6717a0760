#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/road/random_road.h"
#include "dynamics/road/road.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// A column of a file that a run file names.
struct RoadColumn {
  std::string name;
  support::SourceLocation location;
};

/// The road of a run file, `[road]`.
struct RoadDescription {
  std::string shape = "flat";  ///< "flat", one of bump_shape_names(), "random", "table" or "opencrg"
  double start = 0.0;          ///< where it begins [m]
  double length = 0.0;         ///< of a bump, > 0 [m]
  double height = 0.0;         ///< of a bump [m]
  std::filesystem::path file;  ///< of a table or of OpenCRG
  support::SourceLocation file_location;
  RoadColumn distance;              ///< of a table with named columns; without a name, the first
  std::vector<RoadColumn> heights;  ///< the road is their mean; none for a table of two plain columns
  std::vector<double> lateral;  ///< positions across the road in OpenCRG, left is positive; their mean [m]
  support::SourceLocation lateral_location;
  std::optional<RandomRoad> random = {};  ///< of the shape "random"
  support::SourceLocation location;
};

/// Reads `[road]`: shape and the keys of that shape.
/// @param folder  the folder that the key `file` is relative to
/// @throws support::InputError at the first key or value that is wrong
/// Checked by tests/dynamics/input/road_input_test.cpp
RoadDescription read_road(const support::TomlTable& table, const std::filesystem::path& folder);

/// Makes the road of a description; for a table or OpenCRG it reads the file.
/// @throws support::InputError at the fault in the file, or where a road is described that cannot be made
/// Checked by tests/dynamics/input/road_input_test.cpp
std::unique_ptr<Road> make_road(const RoadDescription& description);

/// A text if, at the speed of the start, the leading axle passes the last point of a measured or random road
/// before the run ends, or the vehicle drives away from the road; else "".
/// @param speed  along the heading [m/s]   @param duration  > 0 [s]
/// Checked by tests/dynamics/input/road_input_test.cpp
std::string describe_missed_road(const RoadDescription& description, const Road& road, double speed,
                                 double duration);
/// A text if the leading axle does not reach the road in the run; else "". The arguments are those above.
std::string describe_unreached_road(const Road& road, double speed, double duration);
/// The same with the place of the road in the run file.
std::string remark_on_road(const RoadDescription& description, const Road& road, double speed,
                           double duration);

}  // namespace sprung::dynamics
