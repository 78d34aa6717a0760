#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/element_input/point_reference.h"
#include "dynamics/input/vehicle.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// The kinds of histories that a run file chooses from, in the order of kStoredGroupNames.
enum class StoredGroup {
  kPoints,    ///< motion of named points, centres of mass included
  kBodies,    ///< motion of body frames and modes
  kJoints,    ///< reactions and coordinates
  kForces,    ///< channels of force elements
  kWrenches,  ///< `on_ROLE` of force elements
  kRecovery,  ///< stress resultants along flexible bodies
};
inline constexpr std::array<std::string_view, 6> kStoredGroupNames{"points", "bodies",   "joints",
                                                                   "forces", "wrenches", "recovery"};

enum class StoredPrecision {
  kDouble,
  kSingle,   ///< compressed
  kRounded,  ///< likewise, and numbers of which five digits are enough have no more
};

/// Which histories of a group are stored, and how often.
struct StorageRequest {
  enum class Which { kBySize, kAll, kReported, kNone, kListed };
  Which which = Which::kBySize;  ///< kReported: of points, those in the summary
  std::vector<std::string> names;
  std::vector<support::SourceLocation> locations;  ///< of the names
  std::optional<long> every;                       ///< outputs from one stored row to the next; none: by size
};

/// `[output]` of a run file.
struct OutputSettings {
  std::vector<PointReference> points;  ///< reported in the summary; if empty, the vehicle's `monitor`
  double size = 20.0;  ///< that the histories take at most where nothing else is asked for [MB]
  std::optional<StoredPrecision> precision;  ///< none: by size
  std::array<StorageRequest, kStoredGroupNames.size()> groups;

  const StorageRequest& of(StoredGroup group) const { return groups[static_cast<std::size_t>(group)]; }
};

/// Reads `[output]` (dynamics/models/README.md).
/// @param output_step  of the run [s]
/// @throws support::InputError at a wrong key or value
/// Checked by tests/dynamics/input/output_input_test.cpp
OutputSettings read_output(const support::TomlTable& table, double output_step);

/// Checks that listed points, bodies, joints and forces are those of the vehicle.
/// @throws support::InputError at a name that it lacks
void check_stored_names(const OutputSettings& settings, const Vehicle& vehicle);

}  // namespace sprung::dynamics
