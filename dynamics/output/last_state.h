#pragma once

#include <filesystem>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The state at the last output of a results file, complete or partial.
/// @param model  with the bodies of the file, by name, and the same modes
/// @return branches are not chosen yet
/// @throws support::InputError if the file is damaged, lacks a body, has other modes, or if joints of the
///         model are open at its positions
State read_last_state(const std::filesystem::path& results, const Model& model);

}  // namespace sprung::dynamics
