#pragma once

#include "dynamics/element_input/force_input.h"

namespace sprung::dynamics {

/// Readers of the keys of force elements of suspensions, into a description that has its name and location.
/// @throws support::InputError
/// Checked by tests/dynamics/element_input/suspension_input_test.cpp
void read_hydraulic_stop(const support::TomlTable& table, ForceDescription& force, HistoryFiles& histories);
void read_bushing(const support::TomlTable& table, ForceDescription& force, HistoryFiles& histories);
void read_leaf_spring(const support::TomlTable& table, ForceDescription& force, HistoryFiles& histories);

}  // namespace sprung::dynamics
