#pragma once

#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/simulation/transient.h"
#include "dynamics/statistics/run_statistics.h"
#include "dynamics/statistics/run_warning.h"
#include "tools/support/hdf5/hdf5_file.h"
#include "tools/support/terminal/json.h"

namespace sprung::dynamics {

/// Whether it is printed on stderr, instead of below the tables: it concerns all numbers, or the run fails.
bool goes_to_stderr(const RunWarning& warning);
/// Whether no check of the run has failed.
bool is_converged(const std::vector<RunWarning>& warnings);

/// Says which point the assembly has moved farther than the vehicle's bodies are large; "" if there is none.
std::string describe_far_movement(const Model& model, const AssemblyReport& assembly);
/// The warnings that need no run: of sizes, of bodies that the assembly moved far, and of a start in an
/// unstable equilibrium.
/// @param start  of the run   @param equilibrium  null if none was looked for
std::vector<RunWarning> list_model_warnings(const Model& model, const AssemblyReport& assembly,
                                            const State& start, const Equilibrium* equilibrium);
/// The warnings about a run that has come to its end, the gravest first, without those of the model.
/// @param adaptivity  null if no modes were left out
/// Checked by tests/dynamics/program/warnings_test.py
std::vector<RunWarning> list_run_warnings(const Vehicle& vehicle, const Model& model,
                                          const RunStatistics& statistics,
                                          const TransientStatistics& transient,
                                          const AdaptivityOptions* adaptivity);
/// Remarks on the files that were read: they concern all numbers.
std::vector<RunWarning> list_file_warnings(const std::vector<std::string>& remarks);

/// What they concern, of what, and their texts.
support::Json make_warnings_json(const std::vector<RunWarning>& warnings);

/// Writes /warnings (dynamics/output/results.md); of the places of files their names alone.
void write_warnings(support::Hdf5Writer& file, const std::vector<RunWarning>& warnings);

}  // namespace sprung::dynamics
