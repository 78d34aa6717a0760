#include "dynamics/output/run_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dynamics/output/section_report.h"
#include "dynamics/statistics/missing_modes_warning.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

std::string describe_modes(const Model& model) {
  std::vector<std::string> flexible;
  for (const Body& body : model.bodies) {
    if (body.num_modes() > 0) {
      flexible.push_back(fmt::format("{} with {} {}", body.name, body.num_modes(),
                                     body.num_modes() == 1 ? "mode" : "modes"));
    }
  }
  return flexible.empty() ? "all bodies rigid" : fmt::format("{}", fmt::join(flexible, ", "));
}

void add_certified_row(const CertifiedShare& share, const CertifiedError& body, support::TextTable& run) {
  if (share.point.empty()) return;
  std::string text = fmt::format(
      "{}under the loads of this run, up to {:.4g} Hz {} {:.3g} % of the r.m.s. acceleration of {} along {}; "
      "{:.3g} % of it above",
      body.is_whole() ? "" : "with all its vectors, ", body.highest_hz(),
      body.is_proved() ? "at most" : "about (not proved)", 100.0 * share.missing, share.point,
      share.direction == 0 ? "x" : "y", 100.0 * share.above);
  if (!share.loudest.empty() && share.loudest != share.point)
    text += fmt::format(", {:.3g} % of that of {}", 100.0 * share.loudest_above, share.loudest);
  if (!share.uncovered.empty())
    text += fmt::format("; without loads on {} outside of the interface", share.uncovered);
  run.add_row({"basis of " + body.name() + " misses", text});
}

std::string format_largest(const WorstNeglect& worst, const Model& full) {
  const auto name = [&](const LargestShare& largest) {
    return largest.coordinate < 0 ? std::string("each") : full.coordinate_name(largest.coordinate);
  };
  const std::string deflection =
                        fmt::format("{:.3g} % of the largest deflection", 100.0 * worst.deflection.share),
                    acceleration =
                        fmt::format("{:.3g} % of the largest acceleration", 100.0 * worst.acceleration.share);
  if (worst.deflection.coordinate == worst.acceleration.coordinate)
    return fmt::format("{}: {}, {}", name(worst.deflection), deflection, acceleration);
  return fmt::format("{}: {}; {}: {}", name(worst.deflection), deflection, name(worst.acceleration),
                     acceleration);
}

Json make_largest_json(const LargestShare& largest, const Model& full) {
  return {{"mode", largest.coordinate < 0 ? std::string() : full.coordinate_name(largest.coordinate)},
          {"share", largest.share},
          {"time", largest.time}};
}

Json describe_certified(const std::vector<CertifiedError>& bodies) {
  Json all = Json::object();
  for (const CertifiedError& body : bodies) {
    const CertifiedShare share = body.find_worst();
    if (share.point.empty()) continue;
    all[body.name()] = {{"proved", body.is_proved() && body.is_whole()},
                        {"highest_frequency", body.highest_hz()},
                        {"point", share.point},
                        {"axis", share.direction == 0 ? "x" : "y"},
                        {"of_rms_acceleration", share.missing},
                        {"above_highest_frequency", share.above},
                        {"outside_of_interface", share.uncovered}};
  }
  return all;
}

}  // namespace

std::string describe_run(const Vehicle& vehicle, const Model& model, const Run& run,
                         const AssemblyReport& assembly, const VelocityReport& velocities,
                         const Equilibrium* equilibrium) {
  std::string text =
      fmt::format("{}: {} {} ({}), {}, {} coordinates, {} constraints, {} freedoms\n", vehicle.name,
                  model.bodies.size(), model.bodies.size() == 1 ? "body" : "bodies", describe_modes(model),
                  support::format_count(model.joints.size(), "joint"), model.first_state(),
                  model.num_constraints, model.num_mechanical_freedoms());
  text += assembly.describe_shift();
  if (assembly.largest_movement > 1e-9) {
    text += fmt::format("Assembled: {} moved {:.3g} m to close the joints\n", assembly.moved_marker,
                        assembly.largest_movement);
  }
  if (equilibrium) {
    const std::vector<std::string> neutral = equilibrium->describe_neutral();
    text += fmt::format(
        "{}{} after {} iterations{}{}\n",
        run.start == Run::Start::kSteady ? "Steady motion" : "Static equilibrium",
        equilibrium->stable ? "" : " (unstable)", equilibrium->iterations,
        equilibrium->is_usual()
            ? ""
            : fmt::format(", to {:.1e} of the natural size, limited by rounding", equilibrium->last_step),
        neutral.empty() ? "" : fmt::format("; neutral, kept as given: {}", fmt::join(neutral, "; ")));
  } else {
    text += "Start: positions as given\n";
  }
  if (velocities.largest_change > 1e-9) {
    text += fmt::format(
        "Initial velocities changed to satisfy the joints: {} by {:.3g} of its natural size per s\n",
        velocities.coordinate, velocities.largest_change);
  }
  text += fmt::format("Road: {}; speed {} m/s; {} s, output every {} s; {}, relative tolerance {}\n",
                      run.road.shape, run.speed, run.duration, run.output_step,
                      method_name(run.integrator.options.method), run.integrator.options.relative_tolerance);
  return text;
}

std::string format_summary(const RunSummary& summary) {
  support::TextTable points({"point", "displacement min m", "max m", "r.m.s. m", "acceleration min m/s²",
                             "max m/s²", "r.m.s. m/s²"});
  for (const PointStatistics& point : summary.statistics.point_statistics()) {
    const SampleStatistics& d = point.displacement;
    const SampleStatistics& a = point.acceleration;
    std::vector<std::string> row{point.point};
    for (const double value : {d.minimum, d.maximum, d.rms}) row.push_back(support::format_fixed(value, 4));
    for (const double value : {a.minimum, a.maximum, a.rms}) row.push_back(support::format_fixed(value, 2));
    points.add_row(row);
  }
  const TransientStatistics& transient = summary.transient;
  support::TextTable run({"quantity", "value"});
  run.add_row(
      {"largest constraint violation", fmt::format("{:.1e}", summary.statistics.constraint_violation())});
  if (transient.stepper.velocity_violation > 0.0) {
    run.add_row(
        {"velocity violation before output", fmt::format("{:.1e}", transient.stepper.velocity_violation)});
  }
  run.add_row({"energy balance, relative", fmt::format("{:.1e}", summary.statistics.energy_closure())});
  run.add_row({"steps", fmt::format("{}", transient.stepper.integrator.steps)});
  run.add_row({"evaluations (and for output)",
               fmt::format("{} ({})", transient.stepper.evaluations, transient.output_evaluations)});
  run.add_row({"switches of forces", fmt::format("{}", transient.switches)});
  if (summary.adaptivity) {
    const WorstNeglect& worst = transient.worst_neglect;
    if (summary.adaptivity->changes) {
      run.add_row({"active modes, mean over time", fmt::format("{:.1f}", transient.mean_active_modes)});
      run.add_row({"changes of modes", fmt::format("{}", transient.mode_changes)});
    }
    if (worst.share() > 0.0)
      run.add_row({"largest mode left out", format_largest(worst, *summary.adaptivity->full)});
    if (const MissingAcceleration& missing = transient.missing_acceleration; missing.point >= 0) {
      run.add_row(
          {"modes left out, together",
           fmt::format("{:.3g} % of the r.m.s. acceleration of {}, largest changed by {:.3g} %{}",
                       100.0 * missing.rms_share, name_missing_point(*summary.adaptivity, missing),
                       100.0 * missing.peak_change, summary.adaptivity->continues ? kHistoryUnknown : "")});
    } else if (missing.growth > 0.0) {
      run.add_row({"modes left out, together", describe_growth(missing)});
    }
  }
  for (const CertifiedError& body : summary.statistics.certified())
    add_certified_row(body.find_worst(), body, run);
  const RunTimes& times = summary.times;
  run.add_row({"wall time of the run", fmt::format("{:.3f} s", times.wall)});
  run.add_row({"CPU time of the program", fmt::format("{:.3f} s", times.cpu)});
  run.add_row({"CPU time of the integration", fmt::format("{:.3f} s", times.integration)});
  run.add_row({"real-time factor", fmt::format("{:.0f}", summary.duration / times.wall)});
  std::vector<std::string> texts;
  for (const RunWarning& warning : summary.warnings) {
    if (!goes_to_stderr(warning) && std::find(texts.begin(), texts.end(), warning.text) == texts.end())
      texts.push_back(warning.text);
  }
  std::string warnings;
  for (const std::string& text : texts) warnings += fmt::format("\nwarning: {}\n", text);
  return fmt::format("\nVertical motion, relative to the equilibrium or the given start\n{}{}\n{}{}",
                     points.str(), format_sections(summary.statistics.sections()), run.str(), warnings);
}

Json make_summary_json(const RunSummary& summary) {
  Json modes = Json::object();
  if (summary.adaptivity) {
    const WorstNeglect& worst = summary.transient.worst_neglect;
    modes = {{"mean_active", summary.transient.mean_active_modes},
             {"changes", summary.transient.mode_changes},
             {"largest_left_out",
              {{"of_deflection", make_largest_json(worst.deflection, *summary.adaptivity->full)},
               {"of_acceleration", make_largest_json(worst.acceleration, *summary.adaptivity->full)}}}};
    if (const MissingAcceleration& missing = summary.transient.missing_acceleration; missing.point >= 0) {
      modes["left_out_together"] = {{"point", name_missing_point(*summary.adaptivity, missing)},
                                    {"axis", missing.direction == 0 ? "x" : "y"},
                                    {"of_rms_acceleration", missing.rms_share},
                                    {"change_of_largest_acceleration", missing.peak_change}};
    } else if (missing.growth > 0.0) {
      modes["left_out_together"] = {{"unstable_growth", missing.growth}};
    }
  }
  Json points = Json::object();
  for (const PointStatistics& point : summary.statistics.point_statistics()) {
    const auto statistics = [](const SampleStatistics& sample) -> Json {
      return {{"min", sample.minimum}, {"max", sample.maximum}, {"rms", sample.rms}};
    };
    points[point.point] = {{"displacement", statistics(point.displacement)},
                           {"acceleration", statistics(point.acceleration)}};
  }
  Json bending = Json::object();
  for (const BodyBending& body : summary.statistics.bending()) {
    bending[body.name()] = {{"deflection", body.deflection_share()},
                            {"deflection_time", body.deflection_time()},
                            {"axial_effect", body.axial_effect()}};
  }
  const TransientStatistics& transient = summary.transient;
  Json report{{"points", points},
              {"bending", bending},
              {"sections", make_sections_json(summary.statistics.sections())},
              {"certified", describe_certified(summary.statistics.certified())},
              {"constraint_violation", summary.statistics.constraint_violation()},
              {"velocity_violation", transient.stepper.velocity_violation},
              {"energy_closure", summary.statistics.energy_closure()},
              {"converged", is_converged(summary.warnings)},
              {"steps", transient.stepper.integrator.steps},
              {"evaluations", transient.stepper.evaluations},
              {"output_evaluations", transient.output_evaluations},
              {"switches", transient.switches},
              {"modes", modes},
              {"repartitions", transient.stepper.repartitions},
              {"elapsed", summary.times.wall},
              {"cpu_time", summary.times.cpu},
              {"integration_cpu_time", summary.times.integration},
              {"real_time_factor", summary.duration / summary.times.wall}};
  if (summary.storage) report["storage"] = make_storage_json(*summary.storage);
  return report;
}

}  // namespace sprung::dynamics
