#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dynamics/input/vehicle.h"

namespace sprung::dynamics {

/// Reads `[bodies]`: of each body mass and inertia or a superelement, position, angle and points. At least
/// one body.
/// @throws support::InputError for a key that is missing, unknown or unfit
std::vector<BodyDescription> read_bodies(const support::TomlTable& table);

/// Reads the points of a body or of the ground: NAME = [x, y], or NAME = { node = "…", offset = [x, y] } on a
/// body with a superelement.
/// @param on_superelement  whether points are given by nodes
std::vector<PointDescription> read_points(const support::TomlTable& table, bool on_superelement);

/// FOLDER/NAME.h5 of each superelement that a body names, each read once.
/// @throws support::InputError at the body that names it for a file that is not there, at the file for one
///         that cannot be used, at the point for a node that the superelement lacks or whose name is taken
std::map<std::string, reduce::Superelement> read_superelements(const std::vector<BodyDescription>& bodies,
                                                               const std::filesystem::path& folder);

}  // namespace sprung::dynamics
