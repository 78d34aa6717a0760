#pragma once

#include <filesystem>

#include "dynamics/system/model.h"
#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::dynamics {

/// Makes /last_state of a results file: the names of the coordinates and, for the first, zeros
/// (dynamics/output/results.md).
void make_last_state(support::Hdf5Writer& file, const Model& model);
/// Writes a state there in place of the one before.
void write_last_state(support::Hdf5Writer& file, const State& state);

/// The `speed` of the run that a results file is of [m/s].
/// @throws support::InputError if it is no results file
double read_run_speed(const std::filesystem::path& results);

/// The state at the last output of a results file, complete or partial.
/// @param model  with the bodies of the file, by name, and the same modes. A force element takes over its
///               states by its name; one that the file does not have starts with its states at rest
/// @return branches are not chosen yet
/// @throws support::InputError if the file is damaged, lacks a body, has other modes, or if joints of the
///         model are open at its positions
State read_last_state(const std::filesystem::path& results, const Model& model);

}  // namespace sprung::dynamics
