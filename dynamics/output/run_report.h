#pragma once

#include <string>

#include "dynamics/input/run.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/output/run_statistics.h"

namespace sprung::dynamics {

/// A run in a few lines before it begins: vehicle, modes, freedoms, assembly, equilibrium, road, speed.
/// @param equilibrium  null for a run that starts as given
std::string describe_run(const Vehicle& vehicle, const Model& model, const Run& run,
                         const AssemblyReport& assembly, const VelocityReport& velocities,
                         const Equilibrium* equilibrium);

/// The outcome of a run.
struct RunSummary {
  const RunStatistics& statistics;
  const TransientStatistics& transient;
  double duration = 0.0;                          ///< simulated [s]
  double elapsed = 0.0;                           ///< wall clock [s]
  const AdaptivityOptions* adaptivity = nullptr;  ///< null if no modes were left out
};

/// The summary as text tables, with a warning if a mode left out would contribute much.
std::string format_summary(const Model& model, const RunSummary& summary);
/// The summary as one JSON object, SI units.
std::string format_summary_json(const Model& model, const RunSummary& summary);

}  // namespace sprung::dynamics
