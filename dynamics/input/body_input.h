#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dynamics/input/superelement_cache.h"
#include "dynamics/input/vehicle.h"

namespace sprung::dynamics {

/// Reads `[bodies]`: for each body mass and inertia, or a superelement, position, angle and points. There
/// must be at least one body.
/// @throws support::InputError for a key that is missing, unknown or has a bad value
/// Checked by tests/dynamics/input/vehicle_test.cpp
std::vector<BodyDescription> read_bodies(const support::TomlTable& table);

/// Reads the points of a body or of the ground: NAME = [x, y], or NAME = { node = "…", offset = [x, y] } on a
/// body with a superelement.
/// @param on_superelement  whether the points must be given by nodes
std::vector<PointDescription> read_points(const support::TomlTable& table, bool on_superelement);

/// Reads FOLDER/NAME.h5 of each superelement that a body names, each once.
/// @param cache  of those read before; nullptr: none
/// @throws support::InputError at the body for a file that does not exist; at the file if it cannot be used;
///         at the point for a node that the superelement lacks, or for a name that is taken
/// Checked by tests/dynamics/input/vehicle_test.cpp
std::map<std::string, reduce::Superelement> read_superelements(const std::vector<BodyDescription>& bodies,
                                                               const std::filesystem::path& folder,
                                                               SuperelementCache* cache);

}  // namespace sprung::dynamics
