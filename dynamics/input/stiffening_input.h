#pragma once

#include <map>
#include <set>
#include <string>

#include "dynamics/input/mode_selection.h"
#include "dynamics/input/vehicle.h"
#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

/// Bodies that their axial forces stiffen or soften.
using StiffenedBodies = std::set<std::string>;

/// What a run file says of one body under `[stiffening]`.
struct StiffeningRequest {
  bool on = false;
  std::string key;  ///< for messages: "stiffening.blade"
  support::SourceLocation location;
};
using StiffeningRequests = std::map<std::string, StiffeningRequest>;  ///< by body

/// Reads `[stiffening]`: of each body true or false.
StiffeningRequests read_stiffening(const support::TomlTable& table);

/// The bodies that the requests mean; those that move as rigid ones are left out.
/// @throws support::InputError at the request's place: no such body, a body without superelement, or a
///         superelement without the geometric stiffness of all active modes
StiffenedBodies resolve_stiffening(const StiffeningRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle);

}  // namespace sprung::dynamics
