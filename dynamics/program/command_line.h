#pragma once

#include <string>
#include <vector>

#include "dynamics/preparation/prepared_run.h"

namespace sprung::dynamics {

/// Does what the arguments of sprung-dynamics ask for; the program and the module for Python share it.
///
/// @param arguments  those of the command line, without the program's name
/// @param request    how input is read and where text goes; the arguments fill in the rest
/// @return exit code
/// @throws what support::run_program() turns into exit codes
/// Checked by tests/tools/in_process_test.py
int run_arguments(const std::vector<std::string>& arguments, RunRequest request);

}  // namespace sprung::dynamics
