#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/output/choice_report.h"
#include "dynamics/output/results_writer.h"
#include "dynamics/output/run_report.h"
#include "dynamics/program/commands.h"
#include "dynamics/program/model_report.h"
#include "dynamics/simulation/transient.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/hdf5/foreign_file.h"
#include "tools/support/terminal/program.h"
#include "tools/support/terminal/progress_bar.h"

namespace sprung::dynamics {

namespace {

// Steps and outputs, times coordinates, between two checkpoints: the model's own measure of time, so that
// equal runs have equal checkpoints.
constexpr double kWorkBetweenCheckpoints = 2e6;

TransientOptions make_options(const Run& run) {
  TransientOptions options;
  options.end_time = run.duration;
  options.output_step = run.output_step;
  options.largest_step = run.integrator.largest_step;
  options.integrator = run.integrator.options;
  return options;
}

constexpr double kSmallestScale = 1e-4;    // m: a hundred thousand times the dead band of switches
constexpr double kAlarmingClosure = 1e-3;  // far above the closure at any useful tolerance

[[noreturn]] void throw_interrupted(double time, ResultsWriter* writer) {
  if (!writer) throw support::Interrupted(fmt::format("at t = {:.6g} s", time));
  throw support::Interrupted(
      fmt::format("at t = {:.6g} s; partial results: {}", time, writer->abandon().string()));
}

void print_description(const PreparedRun& prepared) {
  fmt::print("{}", describe_run(prepared.vehicle, prepared.model, prepared.run, prepared.assembly,
                                prepared.initial_velocities,
                                prepared.equilibrium ? &*prepared.equilibrium : nullptr));
  if (prepared.choice) fmt::print("{}", summarise_choice(*prepared.choice));
}

void warn_of_small_scale(double length_scale) {
  if (length_scale >= kSmallestScale) return;
  fmt::print(stderr,
             "warning: no point is farther than {:.1e} m from its body's origin; the dead band of switching "
             "forces, 1e-9 m, is not small against that: use smaller units, as mm with g and ms\n",
             length_scale);
}

// Warns if the energy balance does not close. @return whether it closes
bool check_energy_balance(double closure) {
  if (closure <= kAlarmingClosure) return true;
  fmt::print(
      stderr,
      "warning: the energy balance does not close (relative {:.1e}): do not trust this run; try a smaller "
      "relative tolerance, and look for motion much smaller than the vehicle\n",
      closure);
  return false;
}

std::unique_ptr<ResultsWriter> make_writer(const PreparedRun& prepared, const RunRequest& request,
                                           const std::filesystem::path& path,
                                           const std::optional<AdaptivityOptions>& adaptivity) {
  if (path.empty()) return nullptr;
  std::vector<VehicleMode> modes;
  if (prepared.equilibrium && prepared.equilibrium->stable)
    modes = calc_vehicle_modes(prepared.balance_model, *prepared.equilibrium);
  return std::make_unique<ResultsWriter>(
      path,
      ResultsHeader{prepared.run, prepared.vehicle, prepared.model, prepared.placed_road, prepared.start,
                    request.overrides, prepared.equilibrium ? &*prepared.equilibrium : nullptr,
                    std::move(modes), prepared.output_points, adaptivity ? &*adaptivity : nullptr,
                    prepared.choice ? &*prepared.choice : nullptr});
}

// Runs the model in time and passes its results to `statistics` and to the writer, if there is one. A run
// that is interrupted or fails leaves a file with the results up to there.
TransientStatistics integrate(const PreparedRun& prepared, TransientOptions& options,
                              support::ProgressBar& progress, RunStatistics& statistics,
                              ResultsWriter* writer) {
  double time_reached = 0.0;
  double work = 0.0;  // since the last checkpoint
  options.on_output = [&](const Snapshot& snapshot) {
    work += prepared.model.num_coordinates;
    statistics.add(snapshot);
    if (writer) writer->add(snapshot);
  };
  options.on_event = [&](const Event& event) {
    if (writer) writer->add(event);
  };
  options.on_step = [&](double time) {
    time_reached = time;
    work += prepared.model.num_coordinates;
    if (writer && work >= kWorkBetweenCheckpoints) {
      writer->checkpoint();
      work = 0.0;
    }
    progress.update(time / options.end_time);
    return !support::interrupt_requested();
  };
  TransientStatistics transient;
  try {
    transient = run_transient(prepared.model, prepared.start, options);
  } catch (const support::NumericalError& error) {
    progress.finish();
    if (!writer) throw;
    throw support::NumericalError(
        fmt::format("{}; partial results: {}", error.what(), writer->abandon().string()));
  }
  progress.finish();
  if (!transient.completed) throw_interrupted(time_reached, writer);
  return transient;
}

}  // namespace

int run_command(const RunRequest& request, const RunOutput& output) {
  if (support::is_foreign_file(output.results, kResultsFormat)) {
    throw support::InputError(
        {.path = output.results.string()},
        "exists and is no results file, so it is not overwritten; move it or name another with -o");
  }
  const PreparedRun prepared = prepare_run(request, Preparation::kRun);
  const Run& run = prepared.run;
  if (output.dry_run) {
    fmt::print("{}", output.json ? format_model_json(prepared) : format_model(prepared));
    return support::kGood;
  }
  if (support::interrupt_requested()) throw support::Interrupted("before the run began; nothing was written");
  if (!output.json && !request.quiet) print_description(prepared);
  warn_of_small_scale(prepared.model.length_scale);

  TransientOptions options = make_options(run);
  std::optional<Model> full_model;
  options.adaptivity = make_adaptivity(prepared, full_model);
  const auto writer = make_writer(prepared, request, output.results, options.adaptivity);
  const Eigen::VectorXd& reference = prepared.equilibrium ? prepared.equilibrium->q : prepared.start.q;
  RunStatistics statistics(prepared.model, prepared.output_points, reference, run.statistics_from,
                           run.statistics_to);
  support::ProgressBar progress(request.run_file.filename().string(), request.quiet || output.json);
  const auto start = std::chrono::steady_clock::now();
  const TransientStatistics transient = integrate(prepared, options, progress, statistics, writer.get());
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (writer) writer->finish(statistics, transient);

  const RunSummary summary{statistics, transient, run.duration, elapsed,
                           options.adaptivity ? &*options.adaptivity : nullptr};
  const bool is_trusted = check_energy_balance(statistics.energy_closure());
  fmt::print("{}", output.json ? format_summary_json(prepared.model, summary)
                               : format_summary(prepared.model, summary));
  if (writer && !output.json) fmt::print("Results: {}\n", output.results.string());
  return is_trusted ? support::kGood : support::kCheckFailed;
}

}  // namespace sprung::dynamics
