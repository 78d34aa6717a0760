#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/input/make_model.h"
#include "dynamics/input/run.h"
#include "dynamics/input/superelement_cache.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/mode_choice/basis_choice.h"
#include "dynamics/preparation/static_lengths.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

/// The input that the command line names, and how it is read.
struct RunRequest {
  std::filesystem::path run_file;
  std::filesystem::path superelement_folder;
  std::vector<std::string> overrides;  ///< "key.path=value", "vehicle.key.path=value"
  bool quiet = false;
  support::Streams streams = {};
  SuperelementCache* superelements = nullptr;  ///< of those read by earlier commands, if they are kept
  double earlier_cpu_time = 0.0;               ///< of the process before this command [s]
};

/// A run that is ready to start: input read, vehicle assembled and in equilibrium, road placed under it.
struct PreparedRun {
  Run run;
  Vehicle vehicle;
  std::vector<std::string>
      remarks;              ///< on the vehicle file: unlikely units, functions that end before the run
  ModeSelection selection;  ///< at the start
  ModeSelection available;  ///< of the models below: more than `selection` if modes join and leave
  std::optional<BasisChoice> choice;  ///< present if a body has modes "auto"
  std::vector<std::string> output_points;
  std::vector<StaticLengthResult> static_lengths;
  AssemblyReport assembly;
  VelocityReport initial_velocities;
  std::unique_ptr<Road> level_road, road;
  Model balance_model;                     ///< on level ground
  std::optional<Equilibrium> equilibrium;  ///< none for a run that starts as given
  PlacedRoad placed_road;
  Model model;  ///< on the run's road
  State start;
};

/// The part of the preparation that a command needs.
enum class Preparation {
  kChoice,    ///< up to the choice of the modes
  kBalance,   ///< up to the equilibrium, also for a run that starts as given
  kResponse,  ///< the same, and modes "auto" are chosen from `[response.road]`, if there is one
  kRun,       ///< all of it
};

/// Options for modes that join and leave, or for the indicator of modes left out; none if neither is needed.
/// @param[out] full  filled with the model that the options point to, unless that is prepared.model
std::optional<AdaptivityOptions> make_adaptivity(const PreparedRun& prepared, std::optional<Model>& full);

/// A line of text for each spring whose static length the vehicle file gives.
std::string describe_static_lengths(const PreparedRun& prepared);

/// Reads the input and prepares a run.
/// @throws support::InputError for bad input, support::NumericalError if there is no equilibrium
/// Checked by tests/dynamics/program/bad_input_test.py
PreparedRun prepare_run(const RunRequest& request, Preparation preparation);

}  // namespace sprung::dynamics
