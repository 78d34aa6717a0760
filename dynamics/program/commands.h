#pragma once

#include <filesystem>

#include "dynamics/program/prepared_run.h"

namespace sprung::dynamics {

/// What `run` is told on the command line besides the input.
struct RunOutput {
  std::filesystem::path results;  ///< file to write; empty: none
  bool dry_run = false;           ///< says what would be run, and runs nothing
  bool json = false;              ///< summary as JSON on standard output, in place of tables
};

/// Runs the vehicle and writes its results. @return exit code
int run_command(const RunRequest& request, const RunOutput& output);
/// Prints the static equilibrium. @return exit code
int equilibrium_command(const RunRequest& request, bool json);
/// Prints the vehicle's modes about its static equilibrium. @return exit code
int modes_command(const RunRequest& request, bool json);
/// Prints, and writes where asked to, the vehicle's linear response to the road. @return exit code
int response_command(const RunRequest& request, const RunOutput& output);

}  // namespace sprung::dynamics
