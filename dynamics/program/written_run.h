#pragma once

#include <cstdio>
#include <memory>
#include <optional>

#include "dynamics/output/results_writer.h"
#include "dynamics/output/run_report.h"
#include "dynamics/preparation/prepared_run.h"
#include "dynamics/program/commands.h"
#include "dynamics/simulation/transient.h"
#include "tools/support/terminal/progress_bar.h"

namespace sprung::dynamics {

/// A run as it is written, and where it begins.
struct WrittenRun {
  std::unique_ptr<ResultsWriter> writer;  ///< none if no results are asked for
  std::optional<Checkpoint> checkpoint;   ///< none for a run from its start
};

/// Opens the results; with --resume it takes over those of the partial file, and brings the statistics to its
/// last checkpoint. The partial file stays as it is until the next checkpoint is copied.
/// @throws support::InputError if a file cannot be written or resumed
WrittenRun open_results(const RunOutput& output, const ResultsHeader& header, RunStatistics& statistics);

/// CPU time of the program so far [s].
double cpu_time();

/// Runs the model in time and passes its results to `statistics` and to the writer, if there is one. A run
/// that is interrupted or fails leaves a file with the results up to there.
/// @param[out] times  wall time and that of the integration
/// @throws support::Interrupted, support::NumericalError, support::InputError with the name of that file
TransientStatistics integrate_run(const PreparedRun& prepared, TransientOptions& options,
                                  const WrittenRun& run, support::ProgressBar& progress,
                                  VehicleSections& sections, RunStatistics& statistics, RunTimes& times,
                                  std::FILE* err);

/// Says what is left after an error of writing, as of a full disk, which ends the writing.
void give_up_writing(WrittenRun& run, std::FILE* err);

}  // namespace sprung::dynamics
