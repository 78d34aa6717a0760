#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dynamics/input/road_input.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/output/choice_report.h"
#include "dynamics/preparation/start_state.h"
#include "dynamics/program/commands.h"
#include "dynamics/program/model_report.h"
#include "dynamics/program/results_names.h"
#include "dynamics/program/written_run.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/program.h"
#include "tools/support/terminal/progress_bar.h"

namespace sprung::dynamics {

namespace {

// Between two checkpoints, in steps and outputs and not in seconds, so that equal runs have equal
// checkpoints: about a second of computing, and for large models so many steps that the restart costs little.
constexpr long kCoordinatesBetweenCheckpoints = 2'000'000;
constexpr long kStepsBetweenCheckpoints = 2'000;

long find_checkpoint_interval(const Model& model) {
  return std::max(kStepsBetweenCheckpoints,
                  kCoordinatesBetweenCheckpoints / std::max(model.num_coordinates, 1));
}

TransientOptions make_options(const Run& run, const Model& model) {
  TransientOptions options;
  options.checkpoint_interval = find_checkpoint_interval(model);
  options.end_time = run.duration;
  options.output_step = run.output_step;
  options.largest_step = run.integrator.largest_step;
  options.integrator = run.integrator.options;
  return options;
}

StatisticsWindow make_window(const Run& run, bool is_stored) {
  StatisticsWindow window{
      .from = run.statistics_from, .to = run.statistics_to, .output_step = run.output_step};
  if (is_stored) window.stored_every = run.output.of(StoredGroup::kPoints).every.value_or(1);
  return window;
}

void print_description(std::FILE* out, const PreparedRun& prepared) {
  support::print(
      out, "{}",
      describe_run(prepared.vehicle, prepared.model, prepared.run, prepared.assembly,
                   prepared.initial_velocities, prepared.equilibrium ? &*prepared.equilibrium : nullptr));
  support::print(out, "{}", describe_static_lengths(prepared));
  if (!prepared.run.continue_from.empty()) {
    support::print(out, "Continues from {} at t = {:.6g} s\n", prepared.run.continue_from.string(),
                   prepared.start.time);
  }
  if (prepared.choice) support::print(out, "{}", summarise_choice(*prepared.choice));
}

void print_urgent_warnings(std::FILE* err, const std::vector<RunWarning>& warnings) {
  for (const RunWarning& warning : warnings) {
    if (goes_to_stderr(warning)) support::print(err, "warning: {}\n", warning.text);
  }
}

// Whether a function of time moves a body against the ground. One between two bodies does not drive the
// vehicle.
bool is_driven_from_ground(const Model& model) {
  const auto is_on_ground = [&](int marker) {
    return model.markers[static_cast<std::size_t>(marker)].body == kGround;
  };
  return std::any_of(model.joints.begin(), model.joints.end(), [&](const auto& joint) {
    return !joint->time_functions().empty() &&
           (is_on_ground(joint->marker_a) || is_on_ground(joint->marker_b));
  });
}

// Where the statistics contain what was driven beside the road or behind its end.
void warn_of_missed_road(const PreparedRun& prepared, std::vector<RunWarning>& warnings) {
  const Run& run = prepared.run;
  std::string text = describe_missed_road(run.road, *prepared.road, run.speed, run.statistics_to);
  // Elsewhere 'speed' does not say how far the vehicle comes.
  if (run.continue_from.empty() && run.initial.empty() && !is_driven_from_ground(prepared.model) &&
      text.empty())
    text = describe_unreached_road(*prepared.road, run.speed, run.duration);
  if (text.empty()) return;
  warnings.push_back({"summary", {std::string(kComputation)}, std::move(text)});
}

// Where the given speed is not that of the start. Velocities of [initial] are meant as they are.
void warn_of_other_speed(const PreparedRun& prepared, std::vector<RunWarning>& warnings) {
  const Run& run = prepared.run;
  if (!run.continue_from.empty() || !run.initial.empty() || run.start == Run::Start::kSteady) return;
  std::vector<std::string> motions;
  for (const auto& joint : prepared.model.joints)
    if (joint->is_motion()) motions.push_back("'" + joint->name + "'");
  const std::string prescribed =
      motions.empty() ? "" : fmt::format("prescribed motion ({}) or ", fmt::join(motions, ", "));
  for (const WheelSpeed& wheel : find_wheels_of_other_speed(prepared)) {
    warnings.push_back(
        {"summary",
         {std::string(kComputation)},
         fmt::format(
             "'{}' starts at {:.6g} m/s and not at 'speed', {:g} m/s, which {}joints do not allow: the run "
             "begins with a jolt; give both the same speed",
             wheel.name, wheel.speed, run.speed, prescribed)});
  }
}

ResultsHeader make_header(const PreparedRun& prepared, const RunRequest& request,
                          const std::optional<AdaptivityOptions>& adaptivity,
                          const VehicleSections& sections) {
  std::vector<VehicleMode> modes;
  if (prepared.equilibrium && prepared.equilibrium->stable)
    modes = calc_vehicle_modes(prepared.balance_model, *prepared.equilibrium);
  return {prepared.run,
          prepared.vehicle,
          prepared.model,
          prepared.balance_model,
          prepared.placed_road,
          prepared.start,
          request.overrides,
          prepared.equilibrium ? &*prepared.equilibrium : nullptr,
          std::move(modes),
          prepared.output_points,
          sections,
          adaptivity ? &*adaptivity : nullptr,
          prepared.choice ? &*prepared.choice : nullptr};
}

void print_resumption(std::FILE* out, const std::optional<Checkpoint>& checkpoint) {
  if (checkpoint) {
    support::print(out, "Resumes from the checkpoint at t = {:.6g} s\n", checkpoint->state.time);
  } else {
    support::print(out, "Resumes from the start: the run was interrupted before its first checkpoint\n");
  }
}

// The warnings about the model and its start, of which the urgent ones are printed, and about the files.
std::vector<RunWarning> report_model_warnings(const PreparedRun& prepared, std::FILE* err) {
  std::vector<RunWarning> warnings =
      list_model_warnings(prepared.model, prepared.assembly, prepared.start,
                          prepared.equilibrium ? &*prepared.equilibrium : nullptr);
  warn_of_missed_road(prepared, warnings);
  warn_of_other_speed(prepared, warnings);
  print_urgent_warnings(err, warnings);
  for (RunWarning& remark : list_file_warnings(prepared.remarks))  // printed when the file was read
    warnings.push_back(std::move(remark));
  return warnings;
}

void print_dry_run(const RunRequest& request, const RunOutput& output, const PreparedRun& prepared,
                   const std::vector<RunWarning>& warnings, const StoragePlan& storage) {
  support::print(request.streams.out, "{}",
                 output.json ? format_report_json(request, "run --dry-run", prepared, warnings,
                                                  make_model_json(prepared, storage))
                             : format_model(prepared, storage));
}

void print_run(const RunRequest& request, const RunOutput& output, const PreparedRun& prepared,
               const RunSummary& summary) {
  if (output.json) {
    support::Json report = make_start_json(prepared);
    report.update(make_summary_json(summary));
    support::print(request.streams.out, "{}",
                   format_report_json(request, "run", prepared, summary.warnings, report));
    return;
  }
  support::print(request.streams.out, "{}", format_summary(summary));
  if (!output.results.empty()) support::print(request.streams.out, "Results: {}\n", output.results.string());
}

}  // namespace

int run_command(const RunRequest& request, const RunOutput& output) {
  const support::Streams& streams = request.streams;
  check_results_name(output.results);
  if (output.resume && output.results.empty())
    throw support::InputError({.path = "--resume"}, "needs -o, the name of the results");
  const PreparedRun prepared = prepare_run(request, Preparation::kRun);
  const Run& run = prepared.run;
  check_continued_file(run, output.results);
  const bool prints = !output.json && !request.quiet;
  if (prints && !output.dry_run) print_description(streams.out, prepared);
  const std::vector<RunWarning> model_warnings = report_model_warnings(prepared, streams.err);
  TransientOptions options = make_options(run, prepared.model);
  std::optional<Model> full_model;
  options.adaptivity = make_adaptivity(prepared, full_model);
  VehicleSections sections(prepared.vehicle, prepared.model);
  if (output.dry_run) {
    print_dry_run(request, output, prepared, model_warnings,
                  plan_storage(make_header(prepared, request, options.adaptivity, sections),
                               {prepared.vehicle, prepared.model, sections,
                                options.adaptivity ? options.adaptivity->full : nullptr}));
    return support::kGood;
  }

  const Eigen::VectorXd& reference = prepared.equilibrium ? prepared.equilibrium->q : prepared.start.q;
  const StatisticsWindow window = make_window(run, !output.results.empty());
  RunStatistics statistics(prepared.model, prepared.output_points, reference, window, prepared.vehicle,
                           sections);
  WrittenRun written;
  if (!output.results.empty())
    written = open_results(output, make_header(prepared, request, options.adaptivity, sections), statistics);
  if (written.writer && prints)
    support::print(streams.out, "Results: {}\n", describe_storage(written.writer->storage(), run.output));
  if (output.resume && prints) print_resumption(streams.out, written.checkpoint);
  const support::DeferredInterrupts deferred;  // what was calculated is kept
  support::ProgressBar progress(request.run_file.filename().string(), request.quiet || output.json,
                                streams.err);
  RunTimes times;
  TransientStatistics transient;
  try {
    transient = integrate_run(prepared, options, written, progress, sections, statistics, times, streams.err);
  } catch (const support::InputError&) {
    progress.finish();
    give_up_writing(written, streams.err);
    throw;
  }
  const AdaptivityOptions* adaptivity = options.adaptivity ? &*options.adaptivity : nullptr;
  std::vector<RunWarning> warnings =
      list_run_warnings(prepared.vehicle, prepared.model, statistics, transient, adaptivity);
  print_urgent_warnings(streams.err, warnings);
  warnings.insert(warnings.end(), model_warnings.begin(), model_warnings.end());
  if (written.writer) written.writer->finish(statistics, transient, warnings);
  times.cpu = cpu_time() - request.earlier_cpu_time;
  const double began = written.checkpoint ? written.checkpoint->state.time : prepared.start.time;
  print_run(request, output, prepared,
            {run, statistics, transient, run.duration - began, times, adaptivity, warnings,
             written.writer ? &written.writer->storage() : nullptr});
  return is_converged(warnings) ? support::kGood : support::kCheckFailed;
}

}  // namespace sprung::dynamics
