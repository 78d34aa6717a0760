#pragma once

#include <filesystem>

#include "dynamics/preparation/prepared_run.h"

namespace sprung::dynamics {

/// Options of a command about its output.
struct RunOutput {
  std::filesystem::path results;  ///< file to write; none if empty
  bool resume = false;            ///< continues from the partial file of the same run
  bool dry_run = false;           ///< prints the model and runs nothing
  bool json = false;              ///< prints JSON on standard output in place of tables
  bool bracket = false;           ///< also prints lower and upper bounds of the frequencies
};

/// Runs the vehicle and writes its results. @return exit code
int run_command(const RunRequest& request, const RunOutput& output);
/// Prints the static equilibrium. @return exit code
int equilibrium_command(const RunRequest& request, bool json);
/// Prints the vehicle's modes about its static equilibrium. @return exit code
int modes_command(const RunRequest& request, const RunOutput& output);
/// Prints the modes that the forcing requires; writes them to output.results, if given. @return exit code
int select_modes_command(const RunRequest& request, const RunOutput& output);
/// Prints the vehicle's linear response to the road; writes it to output.results, if given. @return exit code
int response_command(const RunRequest& request, const RunOutput& output);

}  // namespace sprung::dynamics
