#pragma once

#include <string>

#include "dynamics/input/run.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/output/run_statistics.h"

namespace sprung::dynamics {

/// What is going to be run, in a few lines: vehicle, modes, freedoms, assembly, balance, road, speed.
/// @param equilibrium  null for a run that starts as given
std::string describe_run(const Vehicle& vehicle, const Model& model, const Run& run,
                         const AssemblyReport& assembly, const VelocityReport& velocities,
                         const Equilibrium* equilibrium);

/// What came out of a run.
struct RunSummary {
  const RunStatistics& statistics;
  const TransientStatistics& transient;
  double duration = 0.0;                          ///< simulated [s]
  double elapsed = 0.0;                           ///< wall clock [s]
  const AdaptivityOptions* adaptivity = nullptr;  ///< null where nothing was left out
};

/// The summary as tables for people.
std::string format_summary(const Model& model, const RunSummary& summary);
/// The same as one JSON object, SI units.
std::string format_summary_json(const Model& model, const RunSummary& summary);

}  // namespace sprung::dynamics
