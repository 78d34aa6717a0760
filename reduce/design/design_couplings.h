#pragma once

#include <set>
#include <string>

#include "fem/beam_model.h"
#include "tools/support/toml/toml.h"

namespace sprung::reduce {

/// Points that follow others by `[[rigid_offsets]]` and `[[averages]]`: no line needs to pass through them.
std::set<std::string> list_followers(const support::TomlTable& root);

/// Reads `[[rigid_offsets]]` and `[[averages]]` of a design whose mesh is made.
/// @throws support::InputError for a key that is missing, unknown or has a bad value; for a point that
/// follows twice, itself, or one that follows another
/// Checked by tests/reduce/design/couplings_test.py
void read_couplings(const support::TomlTable& root, fem::BeamModel& model);

/// Whether a node follows others. @param node  0-based
bool follows(const fem::BeamModel& model, int node);
/// @throws support::InputError at the value if the node follows others
void expect_no_follower(const fem::BeamModel& model, int node, const support::TomlValue& value,
                        const char* needs);

}  // namespace sprung::reduce
