#pragma once

#include <filesystem>

#include "dynamics/input/run.h"

namespace sprung::dynamics {

/// Refuses to overwrite a file of another program, and a name that partial results have.
/// @param results  of the run, "" for none
/// @throws support::InputError
/// Checked by tests/dynamics/program/continue_test.py and output_test.py
void check_results_name(const std::filesystem::path& results);

/// The file that a run continues is neither replaced nor removed by it.
/// @throws support::InputError at `continue_from` if it is that of the results or of their partial file
/// Checked by tests/dynamics/program/continue_test.py
void check_continued_file(const Run& run, const std::filesystem::path& results);

}  // namespace sprung::dynamics
