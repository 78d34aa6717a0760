#pragma once

#include <utility>

namespace sprung::dynamics {

/// Runs `attempt`, which may evaluate equations elsewhere than where they stand, for example between the ends
/// of a step or beyond its end. If it comes to nothing, `go_back` takes them back.
/// @param attempt  returns std::optional
/// @return what the attempt has found, if anything
template <class Attempt, class GoBack>
auto attempt_or_go_back(Attempt&& attempt, GoBack&& go_back) {
  auto found = std::forward<Attempt>(attempt)();
  if (!found) std::forward<GoBack>(go_back)();
  return found;
}

}  // namespace sprung::dynamics
