#include "dynamics/input/stiffening_input.h"

#include <fmt/format.h>

namespace sprung::dynamics {

StiffeningRequests read_stiffening(const support::TomlTable& table) {
  StiffeningRequests requests;
  for (const auto& [body, value] : table.entries()) {
    requests.emplace(
        body, StiffeningRequest{.on = value.boolean(), .key = value.key(), .location = value.location()});
  }
  return requests;
}

StiffenedBodies resolve_stiffening(const StiffeningRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle) {
  StiffenedBodies stiffened;
  for (const auto& [body, request] : requests) {
    const reduce::Superelement& superelement =
        find_superelement(body, request.key, request.location, vehicle);
    if (!request.on) continue;
    if (!superelement.geometric_stiffness) {
      throw support::InputError(
          request.location,
          fmt::format(
              "'{}' needs the geometric stiffness of superelement '{}', whose file is of version 1 and "
              "has none; build it again from its design with sprung-reduce build",
              request.key, superelement.name));
    }
    const auto active = selection.find(body);
    if (active == selection.end()) continue;
    const int available = superelement.geometric_stiffness->num_modes();
    if (active->second.back() > available) {
      throw support::InputError(
          request.location,
          fmt::format(
              "'{}' cannot be true with mode {}: superelement '{}' has geometric stiffness of its lowest "
              "{} modes",
              request.key, active->second.back(), superelement.name, available));
    }
    stiffened.insert(body);
  }
  return stiffened;
}

}  // namespace sprung::dynamics
