#pragma once

#include "dynamics/element_input/force_input.h"

namespace sprung::dynamics {

/// Reads the keys of an air spring into a description that has its name and location already.
/// @throws support::InputError for a key that is missing or has a bad value
/// Checked by tests/dynamics/element_input/air_spring_input_test.cpp
void read_air_spring(const support::TomlTable& table, ForceDescription& force, HistoryFiles& histories);

}  // namespace sprung::dynamics
