#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/input/make_model.h"
#include "dynamics/input/run.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/mode_choice/basis_choice.h"

namespace sprung::dynamics {

/// What the command line names.
struct RunRequest {
  std::filesystem::path run_file;
  std::filesystem::path superelement_folder;
  std::vector<std::string> overrides;  ///< "key.path=value", "vehicle.key.path=value"
  bool quiet = false;
};

/// A run made ready: input read, vehicle assembled and balanced, road placed under it.
struct PreparedRun {
  Run run;
  Vehicle vehicle;
  ModeSelection selection;  ///< at the start
  ModeSelection available;  ///< of the models below: more than `selection` where modes join and leave
  std::optional<BasisChoice> choice;  ///< of bodies with modes "auto"; none where there are none
  std::vector<std::string> output_points;
  AssemblyReport assembly;
  VelocityReport initial_velocities;
  std::unique_ptr<Road> level_road, road;
  Model balance_model;                     ///< on level ground
  std::optional<Equilibrium> equilibrium;  ///< none for a run that starts as given
  PlacedRoad placed_road;
  Model model;  ///< on the run's road
  State start;
};

/// Which part of the preparation is wanted.
enum class Preparation {
  kChoice,   ///< up to the choice of the modes
  kBalance,  ///< up to the equilibrium, whatever the run's own start
  kRun,      ///< all of it
};

/// How modes join and leave in the run, or what is told of those left out; none where nothing is left out.
/// @param[out] full  filled with the model that the options point to, where it is not prepared.model
std::optional<AdaptivityOptions> make_adaptivity(const PreparedRun& prepared, std::optional<Model>& full);

/// @throws support::InputError, support::NumericalError
PreparedRun prepare_run(const RunRequest& request, Preparation preparation);

}  // namespace sprung::dynamics
