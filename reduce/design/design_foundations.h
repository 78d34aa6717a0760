#pragma once

#include "fem/beam_model.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Reads `[[foundations]]` of a design whose mesh is made: springs spread along a line of nodes, between it
/// and a rigid part that moves with a point, or a second line. They become bushings at the nodes, one element
/// each.
/// @throws support::InputError for a key that is missing, unknown or has a bad value; for lines without
/// nodes, or whose nodes do not face each other
/// Checked by tests/reduce/design/foundations_test.py
void read_foundations(const support::TomlTable& root, fem::BeamModel& model);

}  // namespace sprung::reduce
