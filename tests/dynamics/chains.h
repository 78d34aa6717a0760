#pragma once

#include "dynamics/simulation/transient.h"
#include "dynamics/system/model.h"

namespace sprung::test {

/// A model with a state that satisfies its constraints.
struct Chain {
  dynamics::Model model;
  dynamics::State state;
};

/// A chain of pendulums that hangs from the ground, in a crooked line at rest: as many freedoms as bodies.
/// @param num_links  > 0
Chain make_open_chain(int num_links);

/// Links pinned end to end around a regular polygon, as a track, on a pin to the ground at the first; springs
/// from every fifth link to the ground: num_links − 2 freedoms.
/// @param num_links  > 3
Chain make_closed_chain(int num_links);

}  // namespace sprung::test
