#pragma once

#include <map>
#include <set>
#include <string>

#include "dynamics/input/mode_selection.h"
#include "dynamics/input/vehicle.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Names of the bodies whose bending stiffness depends on axial forces.
using StiffenedBodies = std::set<std::string>;

/// A value of `[stiffening]` in a run file.
struct StiffeningRequest {
  bool on = false;
  std::string key;  ///< for messages: "stiffening.blade"
  support::SourceLocation location;
};
using StiffeningRequests = std::map<std::string, StiffeningRequest>;  ///< by body

/// Reads `[stiffening]`: for each body true or false.
/// Checked by tests/dynamics/input/stiffening_input_test.cpp
StiffeningRequests read_stiffening(const support::TomlTable& table);

/// The bodies that the requests switch on, without those that have no active modes.
/// @throws support::InputError at the request if there is no such body, it has no superelement, or the
///         superelement lacks the geometric stiffness of an active mode
/// Checked by tests/dynamics/input/stiffening_input_test.cpp
StiffenedBodies resolve_stiffening(const StiffeningRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle);

}  // namespace sprung::dynamics
