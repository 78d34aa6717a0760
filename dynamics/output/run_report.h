#pragma once

#include <string>
#include <vector>

#include "dynamics/input/run.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/output/storage_plan.h"
#include "dynamics/statistics/run_statistics.h"
#include "dynamics/statistics/run_warnings.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// A run in a few lines before it begins: vehicle, modes, freedoms, assembly, equilibrium, road, speed.
/// @param equilibrium  null for a run that starts as given
std::string describe_run(const Vehicle& vehicle, const Model& model, const Run& run,
                         const AssemblyReport& assembly, const VelocityReport& velocities,
                         const Equilibrium* equilibrium);

/// What a run took.
struct RunTimes {
  double wall = 0.0;  ///< from the first step to the last output [s]
  double cpu = 0.0;   ///< of the whole program until then [s]
  double integration =
      0.0;  ///< CPU time of the integration and of evaluating its outputs, without storing them [s]
};

/// The outcome of a run.
struct RunSummary {
  const Run& run;
  const RunStatistics& statistics;
  const TransientStatistics& transient;
  double duration = 0.0;  ///< simulated here, from the start or the checkpoint [s]
  RunTimes times;
  const AdaptivityOptions* adaptivity = nullptr;  ///< null if no modes were left out
  const std::vector<RunWarning>& warnings;
  const StoragePlan* storage = nullptr;  ///< null without a results file
};

/// The summary as text tables, with the warnings that do not concern the computation as a whole.
std::string format_summary(const RunSummary& summary);
/// The summary as one JSON object, SI units, without its warnings.
support::Json make_summary_json(const RunSummary& summary);

}  // namespace sprung::dynamics
