#include "dynamics/program/model_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamics/output/balance_report.h"
#include "dynamics/output/choice_report.h"
#include "dynamics/output/run_report.h"
#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

using support::Json;

namespace {

// dynamics/README.md, "JSON"
constexpr std::string_view kJsonFormat = "sprung-dynamics";
constexpr int kJsonVersion = 1;

// A vector of a superelement; only of a mode the frequency is one that the body has (reduce/basis, "Kinds of
// vectors").
std::string describe_vector(const reduce::Superelement& superelement, int number) {
  const std::string kind = superelement.kind_of(number - 1);
  if (kind != reduce::kFreeVector && kind != reduce::kClampedVector)
    return fmt::format("{} ({})", number, kind);
  return fmt::format("{} ({:.2f} Hz)", number, superelement.frequency_hz[number - 1]);
}

std::string list_modes(const reduce::Superelement* superelement, const Body& body) {
  if (superelement == nullptr) return "rigid";
  if (body.num_modes() == 0) return fmt::format("rigid, 0 of {}", superelement->num_modes());
  std::vector<std::string> modes;
  for (const int number : body.mode_numbers) modes.push_back(describe_vector(*superelement, number));
  return fmt::format("{}", fmt::join(modes, ", "));
}

std::vector<std::string> held_directions(const Joint& joint) {
  std::vector<std::string> names;
  for (int k = 0; k < joint.num_constraints(); ++k) names.emplace_back(joint.constraint_name(k));
  return names;
}

const std::string& name_of(const Model& model, int marker) {
  return model.markers[static_cast<std::size_t>(marker)].name;
}

BalanceReport balance_of(const PreparedRun& prepared) {
  return {prepared.balance_model,
          prepared.vehicle,
          *prepared.equilibrium,
          prepared.assembly,
          prepared.run.start == Run::Start::kSteady,
          make_start_positions(prepared.balance_model, prepared.vehicle)};
}

Json describe_road(const RoadDescription& road) {
  Json parameters = Json::object();
  if (road.length > 0.0)
    parameters = {{"start", road.start}, {"length", road.length}, {"height", road.height}};
  if (!road.file.empty()) parameters = {{"start", road.start}, {"file", road.file.string()}};
  if (road.random) {
    parameters = {{"start", road.start},
                  {"length", road.random->length},
                  {"seed", road.random->seed},
                  {"ease", road.random->ease},
                  {"band", {road.random->lowest, road.random->highest}}};
    const double density = road.random->spectrum.density(RoadSpectrum::kReferenceWavenumber);
    if (road.random->rms > 0.0) {
      parameters["rms"] = road.random->rms;
    } else if (density > 0.0) {
      parameters["density"] = density;
    }
  }
  return parameters;
}

// What was asked for; all settings of a run are in its results file.
Json describe_parameters(const PreparedRun& prepared) {
  const Run& run = prepared.run;
  Json modes = Json::object();
  for (const auto& [body, numbers] : prepared.available)
    if (!numbers.empty()) modes[body] = numbers;
  return {{"speed", run.speed},
          {"duration", run.duration},
          {"output_step", run.output_step},
          {"start", start_name(run.start)},
          {"statistics", {run.statistics_from, run.statistics_to}},
          {"road", run.road.shape},
          {"road_parameters", describe_road(run.road)},
          {"method", method_name(run.integrator.options.method)},
          {"relative_tolerance", run.integrator.options.relative_tolerance},
          {"modes", modes}};
}

Json describe_static_springs(const std::vector<StaticLengthResult>& springs) {
  Json all = Json::object();
  for (const StaticLengthResult& spring : springs) {
    Json& one = all[spring.force] = {{"length", spring.length}};
    if (spring.free_length) one["free_length"] = *spring.free_length;
    if (spring.gauge_pressure) one["gauge_pressure"] = *spring.gauge_pressure;
  }
  return all;
}

}  // namespace

std::string format_model(const PreparedRun& prepared, const StoragePlan& storage) {
  const Model& model = prepared.model;
  support::TextTable bodies({"body", "mass kg", "inertia kg·m²", "superelement", "modes"});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const BodyDescription& description = prepared.vehicle.bodies[b];
    bodies.add_row({body.name, fmt::format("{:.6g}", body.mass), fmt::format("{:.6g}", body.second_moment),
                    description.superelement,
                    list_modes(prepared.vehicle.superelement_of(description), body)});
  }
  support::TextTable joints({"joint", "type", "a", "b", "holds"});
  for (const auto& joint : model.joints) {
    joints.add_row({joint->name, std::string(joint->kind()), name_of(model, joint->marker_a),
                    name_of(model, joint->marker_b),
                    fmt::format("{}", fmt::join(held_directions(*joint), ", "))});
  }
  support::TextTable forces({"force element", "type"});
  for (const auto& force : model.forces) forces.add_row({force->name, std::string(force->kind())});

  const Equilibrium* equilibrium = prepared.equilibrium ? &*prepared.equilibrium : nullptr;
  std::string text = describe_run(prepared.vehicle, model, prepared.run, prepared.assembly,
                                  prepared.initial_velocities, equilibrium);
  text += describe_static_lengths(prepared);
  text += fmt::format("\nInertia is about the origin of the body's frame.\n{}", bodies.str());
  if (prepared.choice) text += fmt::format("\n{}", format_choice(*prepared.choice));
  if (!model.joints.empty()) text += fmt::format("\n{}", joints.str());
  if (!model.forces.empty()) text += fmt::format("\n{}", forces.str());
  if (equilibrium != nullptr) text += fmt::format("\n{}", format_equilibrium(balance_of(prepared)));
  text += fmt::format("\nResults: {}\n", describe_storage(storage, prepared.run.output));
  return text;
}

Json make_start_json(const PreparedRun& prepared) {
  Json start = Json::object();
  if (prepared.assembly.shift > 0.0) start["shift"] = prepared.assembly.shift;
  if (prepared.assembly.largest_movement > 0.0)
    start["moved"] = {{"point", prepared.assembly.moved_marker}, {"by", prepared.assembly.largest_movement}};
  if (prepared.initial_velocities.largest_change > 0.0) {
    start["changed_velocity"] = {{"coordinate", prepared.initial_velocities.coordinate},
                                 {"by", prepared.initial_velocities.largest_change}};
  }
  if (prepared.equilibrium) {
    start["balance"] = {{"stable", prepared.equilibrium->stable},
                        {"iterations", prepared.equilibrium->iterations},
                        {"last_step", prepared.equilibrium->last_step},
                        {"neutral", prepared.equilibrium->describe_neutral()}};
  }
  return {{"coordinates", prepared.model.first_state()},
          {"constraints", prepared.model.num_constraints},
          {"freedoms", prepared.model.num_mechanical_freedoms()},
          {"start", start}};
}

Json make_model_json(const PreparedRun& prepared, const StoragePlan& storage) {
  const Model& model = prepared.model;
  Json bodies = Json::object(), joints = Json::object(), forces = Json::object();
  for (const Body& body : model.bodies) {
    bodies[body.name] = {{"mass", body.mass}, {"inertia", body.second_moment}, {"modes", body.mode_numbers}};
  }
  for (const auto& joint : model.joints) {
    joints[joint->name] = {{"type", joint->kind()}, {"holds", held_directions(*joint)}};
  }
  for (const auto& force : model.forces) forces[force->name] = {{"type", force->kind()}};
  Json report{
      {"bodies", bodies}, {"joints", joints}, {"forces", forces}, {"storage", make_storage_json(storage)}};
  report.update(make_start_json(prepared));
  if (prepared.equilibrium) {
    Json places = Json::object();
    for (const Body& body : model.bodies) {
      const Eigen::Vector3d place = prepared.equilibrium->q.segment<3>(body.first_coordinate);
      places[body.name] = {{"x", place[0]}, {"y", place[1]}, {"angle", place[2]}};
    }
    report["equilibrium"] = places;
  }
  return report;
}

std::string format_report_json(const RunRequest& request, std::string_view command,
                               const PreparedRun& prepared, const std::vector<RunWarning>& warnings,
                               const Json& report) {
  Json printed{{"format", kJsonFormat},
               {"version", kJsonVersion},
               {"command", command},
               {"file", request.run_file.string()},
               {"set", request.overrides},
               {"parameters", describe_parameters(prepared)},
               {"warnings", make_warnings_json(warnings)}};
  if (!prepared.static_lengths.empty())
    printed["static_lengths"] = describe_static_springs(prepared.static_lengths);
  if (prepared.choice) printed["mode_choice"] = make_choice_json(*prepared.choice);
  printed.update(report);
  return support::format_json(printed);
}

}  // namespace sprung::dynamics
