#include "dynamics/program/written_run.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "dynamics/output/partial_results.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/files/bytes.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"

namespace sprung::dynamics {

namespace {

// Closing a file of many bodies takes seconds, so the signal is answered before.
[[noreturn]] void throw_interrupted(double time, const RunStatistics& statistics,
                                    const TransientStatistics& transient, ResultsWriter* writer,
                                    std::FILE* err) {
  if (!writer) throw support::Interrupted(fmt::format("at t = {:.6g} s", time));
  support::print(err, "interrupted; completing {}\n", writer->partial().string());
  std::fflush(err);
  writer->write_summary(statistics, transient);
  throw support::Interrupted(
      fmt::format("at t = {:.6g} s; partial results: {}; to continue, run again with --resume", time,
                  writer->abandon().string()));
}

// Wall time [s]. Reading it takes 20 ns, that of the CPU time 500 ns.
double wall_time() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Says once when a checkpoint cannot be copied.
void copy_checkpoint(ResultsWriter& writer, double time, bool& was_said, support::ProgressBar& progress,
                     std::FILE* err) {
  const std::string problem = writer.copy_if_due();
  if (problem.empty() || was_said) return;
  was_said = true;
  progress.finish();
  support::print(
      err,
      "warning: no copy of the results up to t = {:.6g} s: {}; the run goes on, but a kill would cost "
      "what follows the last copy\n",
      time, problem);
}

}  // namespace

double cpu_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

WrittenRun open_results(const RunOutput& output, const ResultsHeader& header, RunStatistics& statistics) {
  std::optional<PartialResults> partial;
  std::optional<PartialResults::RunState> state;
  if (output.resume) state = partial.emplace(output.results, header).read_state(statistics);
  WrittenRun run{std::make_unique<ResultsWriter>(output.results, header), std::nullopt};
  if (!state) return run;
  run.writer->take_over(*partial, state->extent, state->checkpoint);
  run.writer->write_checkpoint(state->checkpoint, statistics);
  run.checkpoint = std::move(state->checkpoint);
  return run;
}

TransientStatistics integrate_run(const PreparedRun& prepared, TransientOptions& options,
                                  const WrittenRun& run, support::ProgressBar& progress,
                                  VehicleSections& sections, RunStatistics& statistics, RunTimes& times,
                                  std::FILE* err) {
  const double start_time = prepared.start.time;
  double time_reached = run.checkpoint ? run.checkpoint->state.time : start_time;
  ResultsWriter* writer = run.writer.get();
  const double cpu_before = cpu_time();
  const double start = wall_time();
  bool was_said = false;  // that there is no copy
  double storing = 0.0;   // wall time of what is done with outputs and checkpoints [s]
  options.on_output = [&](const Snapshot& snapshot) {
    storing -= wall_time();
    sections.update(snapshot.terms(), snapshot.multipliers(), snapshot.q, snapshot.v, snapshot.v_dot);
    statistics.add(snapshot);
    if (writer) writer->add(snapshot);
    storing += wall_time();
  };
  options.on_time_between = [&](double time, const SystemStepper::Observation& now, const Energy& stored) {
    storing -= wall_time();
    sections.update(now.equations.terms(), now.equations.multipliers(), now.q, now.v, now.v_dot);
    statistics.add_between(time, now.equations, stored);
    storing += wall_time();
  };
  options.on_event = [&](const Event& event) {
    if (writer) writer->add(event);
  };
  options.on_checkpoint = [&](const Checkpoint& checkpoint) {
    storing -= wall_time();
    if (writer) {
      writer->write_checkpoint(checkpoint, statistics);
      copy_checkpoint(*writer, checkpoint.state.time, was_said, progress, err);
    }
    storing += wall_time();
  };
  options.on_step = [&](double time) {
    time_reached = time;
    progress.update((time - start_time) / (options.end_time - start_time));
    return !support::interrupt_requested();
  };
  TransientStatistics transient;
  try {
    transient = run.checkpoint ? resume_transient(prepared.model, *run.checkpoint, options)
                               : run_transient(prepared.model, prepared.start, options);
  } catch (const support::NumericalError& error) {
    progress.finish();
    if (!writer) throw;
    throw support::NumericalError(
        fmt::format("{}; partial results: {}", error.what(), writer->abandon().string()));
  } catch (const support::DamagedBytes& error) {
    writer->discard();
    throw support::InputError({.path = writer->partial().string()},
                              fmt::format("cannot be resumed: {}; run without --resume", error.what()));
  }
  progress.finish();
  times.wall = wall_time() - start;
  times.integration = (cpu_time() - cpu_before) * (1.0 - storing / times.wall);
  if (transient.completed) return transient;
  throw_interrupted(time_reached, statistics, transient, writer, err);
}

void give_up_writing(WrittenRun& run, std::FILE* err) {
  if (!run.writer) return;
  const std::filesystem::path partial = run.writer->partial();
  const bool has_checkpoint = run.writer->has_checkpoint();
  run.writer.reset();
  std::error_code ignored;
  if (has_checkpoint && std::filesystem::exists(partial, ignored))
    support::print(err, "partial results: {}; to continue, run again with --resume\n", partial.string());
}

}  // namespace sprung::dynamics
