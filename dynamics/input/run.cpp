#include "dynamics/input/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

namespace {

constexpr double kMostOutputs = 1e7, kMostSteps = 1e9;
constexpr double kShortestRun = 1e-9;  // s; the methods take no steps below 1e-10 s
const std::array<std::string, 3> kStarts{"equilibrium", "steady", "as-given"};  // as Run::Start

void read_times(const support::TomlTable& root, Run& run) {
  run.duration = root.number("duration", {.unit = "s", .at_least = kShortestRun});
  run.duration_location = root.at("duration").location();
  run.output_step = root.number_or("output_step", run.output_step, support::positive("s"));
  const support::SourceLocation where =
      root.has("output_step") ? root.at("output_step").location() : root.at("duration").location();
  if (!(run.output_step <= run.duration)) {
    throw support::InputError(where, fmt::format("'output_step' of {} s must be at most the duration of {} s",
                                                 run.output_step, run.duration));
  }
  if (!(run.duration / run.output_step <= kMostOutputs)) {
    throw support::InputError(
        where, fmt::format("'output_step' of {} s gives {:.3g} outputs in {} s, must be at most "
                           "{:.0e}",
                           run.output_step, run.duration / run.output_step, run.duration, kMostOutputs));
  }
}

void read_statistics(const support::TomlTable& root, Run& run) {
  run.statistics_to = run.duration;
  const std::optional<support::TomlTable> table = root.find_table("statistics");
  if (!table) return;
  const support::Quantity inside{.unit = "s", .at_least = 0.0, .at_most = run.duration};
  run.statistics_from = table->number_or("from", 0.0, inside);
  run.statistics_to = table->number_or("to", run.duration, inside);
  table->reject_unknown_keys();
  if (!(run.statistics_to > run.statistics_from)) {
    throw table->error(fmt::format("must end after it begins, got from {} s to {} s", run.statistics_from,
                                   run.statistics_to));
  }
  const double first_output = std::ceil(run.statistics_from / run.output_step - 1e-6) * run.output_step;
  if (first_output > run.statistics_to * (1.0 + 1e-12)) {
    throw table->error(
        fmt::format("must hold an output; from {} s to {} s there is none at an output_step of {} s",
                    run.statistics_from, run.statistics_to, run.output_step));
  }
}

IntegratorSettings read_integrator(const support::TomlTable& table, double duration) {
  const support::Quantity step{.unit = "s", .at_least = duration / kMostSteps};
  static const std::vector<std::string> kNames(kMethodNames.begin(), kMethodNames.end());
  IntegratorSettings settings;
  if (const std::optional<support::TomlValue> method = table.find("method")) {
    const auto place = std::find(kNames.begin(), kNames.end(), method->one_of(kNames));
    settings.names_method = true;
    settings.options.method = static_cast<SteppingMethod>(place - kNames.begin());
  }
  // With a tolerance below 1e-13, rounding of the evaluation would be mistaken for error of the step.
  settings.options.relative_tolerance =
      table.number_or("relative_tolerance", settings.options.relative_tolerance,
                      {.unit = "", .at_least = 1e-13, .at_most = 1e-1});
  if (const std::optional<support::TomlValue> largest = table.find("largest_step")) {
    settings.largest_step = largest->number(step);
  }
  const std::optional<support::TomlValue> radius = table.find("spectral_radius");
  const std::optional<support::TomlValue> fixed_step = table.find("fixed_step");
  for (const auto& value : {radius, fixed_step}) {
    if (value && !(settings.names_method && settings.options.method == SteppingMethod::kGeneralizedAlpha)) {
      throw value->error("has a meaning with method = \"generalized-alpha\" only");
    }
  }
  if (radius)
    settings.options.generalized_alpha.spectral_radius =
        radius->number({.unit = "", .at_least = 0.0, .at_most = 1.0});
  if (fixed_step) settings.options.generalized_alpha.fixed_step = fixed_step->number(step);
  table.reject_unknown_keys();
  return settings;
}

AdaptivitySettings read_adaptivity(const support::TomlTable& table) {
  AdaptivitySettings settings;
  AdaptivityThresholds& thresholds = settings.thresholds;
  settings.location = table.location();
  if (const auto enabled = table.find("enabled")) settings.enabled = enabled->boolean();
  if (const auto indicator = table.find("indicator")) settings.indicator = indicator->boolean();
  thresholds.recall =
      table.number_or("recall", thresholds.recall, {.unit = "", .at_least = 1e-9, .at_most = 1.0});
  thresholds.drop =
      table.number_or("drop", std::min(thresholds.drop, 0.2 * thresholds.recall), support::non_negative(""));
  thresholds.residence = table.number_or("residence", thresholds.residence, support::non_negative("s"));
  if (const auto available = table.find_table("available")) {
    settings.available = read_modes(*available);
    for (const auto& [body, request] : settings.available) {
      if (request.kind != ModeRequest::Kind::kAuto) continue;
      throw support::InputError(
          request.location,
          fmt::format("'{}' must be a number of modes, a list of mode numbers or \"all\"; \"auto\" "
                      "chooses from what is available, in [modes]",
                      request.key));
    }
  }
  table.reject_unknown_keys();
  if (!(thresholds.drop < thresholds.recall)) {
    throw table.error(
        fmt::format("must have 'drop' below 'recall', got {} and {}", thresholds.drop, thresholds.recall));
  }
  return settings;
}

std::map<std::string, InitialMotion> read_initial(const support::TomlTable& table) {
  std::map<std::string, InitialMotion> initial;
  for (const auto& [body, value] : table.entries()) {
    const support::TomlTable entry = value.table();
    InitialMotion motion;
    motion.location = entry.location();
    if (const std::optional<support::TomlValue> velocity = entry.find("velocity")) {
      const std::vector<double> v = velocity->numbers(support::any("m/s"), 2);
      motion.velocity = {v[0], v[1]};
    }
    motion.angular_velocity = entry.number_or("angular_velocity", 0.0, support::any("rad/s"));
    if (const std::optional<support::TomlValue> amplitude = entry.find("modal_amplitude")) {
      motion.modal_amplitude = amplitude->numbers(support::any(""));
    }
    if (const std::optional<support::TomlValue> rate = entry.find("modal_rate")) {
      motion.modal_rate = rate->numbers(support::any("1/s"));
    }
    entry.reject_unknown_keys();
    initial.emplace(body, std::move(motion));
  }
  return initial;
}

std::vector<JointRateRequest> read_joint_rates(const support::TomlTable& table) {
  std::vector<JointRateRequest> rates;
  for (const auto& [joint, value] : table.entries()) {
    rates.push_back({joint, value.number(support::any("rad/s or m/s")), value.location()});
  }
  return rates;
}

// Names of the points without repetition.
std::vector<std::string> resolve_points(const std::vector<PointReference>& points, const Vehicle& vehicle) {
  const std::vector<std::string> known = point_names(vehicle);
  std::vector<std::string> names;
  for (const PointReference& point : points) {
    check_point(point, known);
    if (std::find(names.begin(), names.end(), point.name) == names.end()) names.push_back(point.name);
  }
  return names;
}

const Body& find_moved_body(const Model& model, const std::string& name, const InitialMotion& motion) {
  const int index = model.find_body(name);
  if (index >= 0) return model.bodies[static_cast<std::size_t>(index)];
  std::vector<std::string> names;
  for (const Body& body : model.bodies) names.push_back(body.name);
  throw support::InputError(motion.location, fmt::format("'initial.{}' is about no body of the vehicle{}",
                                                         name, support::nearest_name_hint(name, names)));
}

// Adds values to the part of q or v that belongs to a body's modes.
void add_modal_values(const Body& body, const std::vector<double>& values, const char* key,
                      const InitialMotion& motion, Eigen::VectorXd& coordinates) {
  if (values.empty()) return;
  if (values.size() != body.mode_numbers.size()) {
    throw support::InputError(
        motion.location,
        fmt::format("'initial.{}.{}' must be one number for each of the {}, got {}", body.name, key,
                    support::format_count(body.mode_numbers.size(), "available mode"), values.size()));
  }
  coordinates.segment(body.first_coordinate + 3, body.num_modes()) +=
      Eigen::Map<const Eigen::VectorXd>(values.data(), body.num_modes());
}

}  // namespace

std::string_view start_name(Run::Start start) {
  return kStarts[static_cast<std::size_t>(start)];
}

Run read_run(const support::TomlDocument& document) {
  const support::TomlTable root = document.root();
  const std::filesystem::path folder = std::filesystem::path(document.name()).parent_path();
  Run run;
  run.text = document.text();
  if (!root.find("vehicle")) {
    if (const auto bodies = root.find("bodies"))
      throw bodies->error(
          "belongs to a vehicle file, expected a run file: it names the vehicle file by 'vehicle'");
  }
  run.vehicle_path = folder / root.string("vehicle");
  run.vehicle_location = root.at("vehicle").location();
  run.speed = root.number_or("speed", 0.0, support::any("m/s"));
  run.has_speed = root.has("speed");
  run.speed_location = run.has_speed ? root.at("speed").location() : root.location();
  read_times(root, run);
  read_statistics(root, run);
  if (const std::optional<support::TomlValue> start = root.find("start")) {
    const auto found = std::find(kStarts.begin(), kStarts.end(), start->one_of(kStarts));
    run.start = static_cast<Run::Start>(found - kStarts.begin());
    run.start_location = start->location();
  }
  if (const std::optional<support::TomlValue> results = root.find("continue_from")) {
    run.continue_from = folder / results->string();
    run.continue_location = results->location();
    for (const char* start : {"initial", "joint_rates"}) {
      if (root.has(start)) throw results->error(fmt::format("and '{}' exclude each other", start));
    }
  }
  if (const auto table = root.find_table("modes")) run.modes = read_modes(*table);
  if (const auto table = root.find_table("mode_choice")) run.mode_choice = read_mode_choice(*table);
  if (const auto table = root.find_table("modal_damping")) run.modal_damping = read_modal_damping(*table);
  if (const auto table = root.find_table("stiffening")) run.stiffening = read_stiffening(*table);
  if (const auto table = root.find_table("road")) run.road = read_road(*table, folder);
  if (const auto table = root.find_table("integrator"))
    run.integrator = read_integrator(*table, run.duration);
  if (const auto table = root.find_table("adaptivity")) run.adaptivity = read_adaptivity(*table);
  if (const auto table = root.find_table("initial")) run.initial = read_initial(*table);
  if (const auto table = root.find_table("joint_rates")) run.joint_rates = read_joint_rates(*table);
  if (const auto table = root.find_table("output")) run.output = read_output(*table, run.output_step);
  run.response.location = {.path = document.name()};
  if (const auto table = root.find_table("response")) run.response = read_response(*table);
  root.reject_unknown_keys();
  return run;
}

ModeSelection resolve_modes(const Run& run, const Vehicle& vehicle) {
  ModeRequests requests = run.modes;
  if (run.adaptivity.enabled) {  // "auto" chooses from the modes that may be recalled
    for (const std::string& body : list_automatic_bodies(run.modes)) {
      const auto available = run.adaptivity.available.find(body);
      if (available != run.adaptivity.available.end()) requests[body] = available->second;
    }
  }
  return resolve_modes(requests, vehicle);
}

ModeSelection resolve_available_modes(const Run& run, const ModeSelection& selected, const Vehicle& vehicle) {
  ModeRequests requests = run.adaptivity.available;
  if (!run.adaptivity.enabled) {
    resolve_modes(requests, vehicle);  // reports mistakes, although the result is not used
    return selected;
  }
  for (const auto& [body, request] : run.modes) {
    ModeRequest all = request;
    all.kind = ModeRequest::Kind::kAll;
    requests.emplace(body, all);  // no effect if the body has a request already
  }
  ModeSelection available = resolve_modes(requests, vehicle);
  for (const auto& [body, numbers] : selected) {
    std::vector<int>& all = available[body];
    all.insert(all.end(), numbers.begin(), numbers.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  }
  return available;
}

std::string describe_early_end(const Run& run, double start_time) {
  const double span = run.duration - start_time;
  const double steps = span / run.output_step, last = std::floor(steps + 1e-9) * run.output_step;
  if (span - last <= 1e-6 * run.output_step) return {};
  const std::string rest = start_time > 0.0 ? fmt::format("the rest of {:.9g} s", span) : "the duration";
  return fmt::format(
      "{}: the last output is at {:.9g} s, and what the vehicle does up to {:.9g} s is not put out: {} is no "
      "multiple of the output_step of {:.9g} s",
      support::format_place(run.duration_location), start_time + last, run.duration, rest, run.output_step);
}

std::vector<std::string> resolve_output_points(const Run& run, const Vehicle& vehicle) {
  check_stored_names(run.output, vehicle);
  return resolve_points(run.output.points.empty() ? vehicle.monitor : run.output.points, vehicle);
}

std::vector<std::string> resolve_response_points(const Run& run, const Vehicle& vehicle) {
  if (run.response.points.empty()) return resolve_output_points(run, vehicle);
  return resolve_points(run.response.points, vehicle);
}

void add_initial_amplitudes(const Run& run, const Model& model, Eigen::VectorXd& q) {
  for (const auto& [name, motion] : run.initial) {
    add_modal_values(find_moved_body(model, name, motion), motion.modal_amplitude, "modal_amplitude", motion,
                     q);
  }
}

Eigen::VectorXd make_start_velocities(const Run& run, const Vehicle& vehicle, const Model& model) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(model.num_coordinates);
  for (const Body& body : model.bodies) v[body.first_coordinate] = vehicle.direction * run.speed;
  for (const auto& [name, motion] : run.initial) {
    const Body& body = find_moved_body(model, name, motion);
    v.segment<2>(body.first_coordinate) += motion.velocity;
    v[body.first_coordinate + 2] += motion.angular_velocity;
    add_modal_values(body, motion.modal_rate, "modal_rate", motion, v);
  }
  return v;
}

}  // namespace sprung::dynamics
