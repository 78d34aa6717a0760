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

TransientOptions make_options(const Run& run) {
  TransientOptions options;
  options.end_time = run.duration;
  options.output_step = run.output_step;
  options.largest_step = run.integrator.largest_step;
  options.integrator = run.integrator.options;
  return options;
}

constexpr double kSmallestScale = 1e-4;    // m: a hundred thousand dead bands of switches
constexpr double kAlarmingClosure = 1e-3;  // far above what any usable tolerance gives

[[noreturn]] void throw_interrupted(double time, ResultsWriter* writer) {
  if (!writer) throw support::Interrupted(fmt::format("at t = {:.6g} s", time));
  throw support::Interrupted(
      fmt::format("at t = {:.6g} s; what there is so far: {}", time, writer->abandon().string()));
}

}  // namespace

int run_command(const RunRequest& request, const RunOutput& output) {
  if (support::is_foreign_file(output.results, kResultsFormat)) {
    throw support::InputError(
        {.path = output.results.string()},
        "is in the way and is left alone: it is no results file; move it or name another with -o");
  }
  const PreparedRun prepared = prepare_run(request, Preparation::kRun);
  if (output.dry_run) {
    fmt::print("{}", output.json ? format_model_json(prepared) : format_model(prepared));
    return support::kGood;
  }
  const Run& run = prepared.run;
  std::vector<VehicleMode> modes;
  if (!output.results.empty() && prepared.equilibrium && prepared.equilibrium->stable) {
    modes = calc_vehicle_modes(prepared.balance_model, *prepared.equilibrium);
  }
  if (!output.json && !request.quiet) {
    fmt::print("{}", describe_run(prepared.vehicle, prepared.model, run, prepared.assembly,
                                  prepared.initial_velocities,
                                  prepared.equilibrium ? &*prepared.equilibrium : nullptr));
    if (prepared.choice) fmt::print("{}", summarise_choice(*prepared.choice));
  }

  if (prepared.model.length_scale < kSmallestScale) {
    fmt::print(stderr,
               "warning: no point is farther than {:.1e} m from its body's origin; forces that switch do so "
               "within 1e-9 m, "
               "which will be seen: give lengths in a larger unit, as mm with g and ms\n",
               prepared.model.length_scale);
  }
  TransientOptions options = make_options(run);
  std::optional<Model> full_model;
  options.adaptivity = make_adaptivity(prepared, full_model);
  std::unique_ptr<ResultsWriter> writer;
  if (!output.results.empty()) {
    writer = std::make_unique<ResultsWriter>(
        output.results,
        ResultsHeader{run, prepared.vehicle, prepared.model, prepared.placed_road, prepared.start,
                      request.overrides, prepared.equilibrium ? &*prepared.equilibrium : nullptr,
                      std::move(modes), prepared.output_points,
                      options.adaptivity ? &*options.adaptivity : nullptr,
                      prepared.choice ? &*prepared.choice : nullptr});
  }
  const Eigen::VectorXd& reference = prepared.equilibrium ? prepared.equilibrium->q : prepared.start.q;
  RunStatistics statistics(prepared.model, prepared.output_points, reference, run.statistics_from,
                           run.statistics_to);

  support::ProgressBar progress(request.run_file.filename().string(), request.quiet || output.json);
  double time_reached = 0.0;
  options.on_output = [&](const Snapshot& snapshot) {
    statistics.add(snapshot);
    if (writer) writer->add(snapshot);
  };
  options.on_event = [&](const Event& event) {
    if (writer) writer->add(event);
  };
  options.on_step = [&](double time) {
    time_reached = time;
    progress.update(time / run.duration);
    return !support::interrupt_requested();
  };
  const auto start = std::chrono::steady_clock::now();
  TransientStatistics transient;
  try {
    transient = run_transient(prepared.model, prepared.start, options);
  } catch (const support::NumericalError& error) {
    progress.finish();
    if (!writer) throw;
    throw support::NumericalError(
        fmt::format("{}; results up to there: {}", error.what(), writer->abandon().string()));
  }
  progress.finish();
  if (!transient.completed) throw_interrupted(time_reached, writer.get());
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (writer) writer->finish(statistics, transient);

  const RunSummary summary{statistics, transient, run.duration, elapsed,
                           options.adaptivity ? &*options.adaptivity : nullptr};
  const bool is_trusted = statistics.energy_closure() <= kAlarmingClosure;
  if (!is_trusted) {
    fmt::print(
        stderr,
        "warning: the energy balance does not close (relative {:.1e}): do not trust this run; try a smaller "
        "relative tolerance, and look for motion far below the vehicle's size\n",
        statistics.energy_closure());
  }
  fmt::print("{}", output.json ? format_summary_json(prepared.model, summary)
                               : format_summary(prepared.model, summary));
  if (writer && !output.json) fmt::print("Results: {}\n", output.results.string());
  return is_trusted ? support::kGood : support::kCheckFailed;
}

}  // namespace sprung::dynamics
