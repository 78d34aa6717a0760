#include "dynamics/preparation/prepared_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/input/uncovered_loads.h"
#include "dynamics/input/unit_remarks.h"
#include "dynamics/preparation/automatic_modes.h"
#include "dynamics/preparation/full_model.h"
#include "dynamics/preparation/massless_check.h"
#include "dynamics/preparation/start_state.h"
#include "dynamics/preparation/unlikely_balance.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/statistics/run_warnings.h"
#include "tools/support/errors/numerical_error.h"
#include "tools/support/files/read_text_file.h"
#include "tools/support/terminal/print.h"
#include "tools/support/terminal/progress_bar.h"

namespace sprung::dynamics {

namespace {

constexpr std::string_view kVehiclePrefix = "vehicle.";
constexpr double kNoRate = 1e-10;  // rate of a mode at the start that counts as zero, of all velocities

bool needs_balance_alone(Preparation preparation) {
  return preparation == Preparation::kBalance || preparation == Preparation::kResponse;
}

// Applies the overrides of one of the two files; messages locate them by their number on the command line.
void apply_overrides(support::TomlDocument& document, const std::vector<std::string>& overrides,
                     bool of_vehicle) {
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    const bool is_of_vehicle = overrides[i].starts_with(kVehiclePrefix);
    if (is_of_vehicle != of_vehicle) continue;
    const std::string_view assignment = overrides[i];
    document.set(of_vehicle ? assignment.substr(kVehiclePrefix.size()) : assignment,
                 fmt::format("--set {}", i + 1));
  }
}

bool only_modes_are_free(const Model& model, const Eigen::VectorXd& q) {
  PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  const std::vector<int>& free = equations.partition().independent;
  return std::all_of(free.begin(), free.end(), [&](int i) {
    const BodyCoordinate coordinate = model.body_coordinate(i);
    return coordinate.is_modal() || coordinate.is_state();
  });
}

// The steady motion relative to which a run starts in equilibrium.
SteadyMotion find_motion(const Run& run, const Model& model, const Eigen::VectorXd& q) {
  if (run.start != Run::Start::kSteady) return {};
  if (const std::optional<SteadyMotion> motion = find_steady_motion(model, q)) return *motion;
  // Modes are at rest in their bodies for any motion of these.
  if (only_modes_are_free(model, q)) return {};
  throw support::InputError(run.start_location,
                            "'start' can be \"steady\" only where prescribed motion moves the whole system "
                            "like one rigid body, or leaves nothing free but modes");
}

void check_steady(const Run& run, const Model& model, const Equilibrium& equilibrium) {
  if (is_steady(model, equilibrium.motion, equilibrium.q)) return;
  throw support::InputError(
      run.start_location,
      "'start' can be \"steady\" only where the moving system sees the same forces at all times: not with "
      "weight on a rotating system, springs to the ground, or a motion whose rate changes");
}

// Activates the modes that have a velocity at the start, because a held mode has none.
void activate_moving_modes(const Model& model, const State& start, std::vector<bool>& active) {
  double energy = 0.0;  // twice the kinetic energy, without coupling terms
  for (const Body& body : model.bodies) {
    energy += body.mass * start.v.segment<2>(body.first_coordinate).squaredNorm();
    energy += body.second_moment * std::pow(start.v[body.first_coordinate + 2], 2);
    const Eigen::VectorXd eta_dot = start.v.segment(body.first_coordinate + 3, body.num_modes());
    energy += eta_dot.dot(body.M_ff * eta_dot);
  }
  for (const Body& body : model.bodies) {
    for (int k = 0; k < body.num_modes(); ++k) {
      const int i = body.first_coordinate + 3 + k;
      const double share = body.M_ff(k, k) * start.v[i] * start.v[i];
      if (share > kNoRate * kNoRate * energy) active[static_cast<std::size_t>(i)] = true;
    }
  }
}

void read_files(const RunRequest& request, Preparation preparation, PreparedRun& prepared) {
  support::TomlDocument run_document = support::TomlDocument::read(request.run_file);
  apply_overrides(run_document, request.overrides, false);
  prepared.run = read_run(run_document);
  take_continued_speed(prepared.run);
  if (!support::is_regular_file(prepared.run.vehicle_path)) {
    throw support::InputError(prepared.run.vehicle_location,
                              fmt::format("there is no vehicle file {}", prepared.run.vehicle_path.string()));
  }
  support::TomlDocument vehicle_document = support::TomlDocument::read(prepared.run.vehicle_path);
  apply_overrides(vehicle_document, request.overrides, true);
  prepared.vehicle = read_vehicle(vehicle_document, request.superelement_folder, request.superelements);
  // Equilibrium and linearisation need functions of time at t = 0 alone.
  const double end = needs_balance_alone(preparation) ? 0.0 : prepared.run.duration;
  check_histories(prepared.vehicle.histories, end);
  prepared.remarks = list_unit_remarks(prepared.run, prepared.vehicle);
  for (std::string& remark : list_history_remarks(prepared.vehicle.histories, end))
    prepared.remarks.push_back(std::move(remark));
  if (request.quiet) return;
  for (const std::string& remark : prepared.remarks)
    support::print(request.streams.err, "remark: {}\n", remark);
}

// Damping and stiffening of the flexible bodies of the models.
struct ModalProperties {
  ModalDamping damping;
  StiffenedBodies stiffened;
};

// Selects the modes that the run file asks for, and chooses those of bodies with modes "auto".
ModalProperties choose_modes(Preparation preparation, PreparedRun& prepared) {
  const Run& run = prepared.run;
  const Vehicle& vehicle = prepared.vehicle;
  prepared.selection = resolve_modes(run, vehicle);
  prepared.available = resolve_available_modes(run, prepared.selection, vehicle);
  ModalProperties properties{.damping = resolve_modal_damping(run.modal_damping, prepared.available, vehicle),
                             .stiffened = resolve_stiffening(run.stiffening, prepared.available, vehicle)};
  if (run.adaptivity.enabled && !properties.stiffened.empty()) {
    throw support::InputError(
        run.adaptivity.location,
        "'adaptivity' cannot be enabled together with 'stiffening': held modes would not be stiffened; "
        "take a fixed set of modes, or leave stiffening out");
  }
  if (list_automatic_bodies(run.modes).empty()) return properties;
  const ModalDamping start_damping = keep_damping(properties.damping, prepared.available, prepared.selection);
  const bool is_of_response = preparation == Preparation::kResponse && run.response.road && run.speed > 0.0;
  prepared.choice =
      choose_automatic_modes(run, vehicle, prepared.selection, start_damping, properties.stiffened,
                             is_of_response ? make_road_of_response(run) : make_road_of_run(run));
  prepared.selection = keep_modes(*prepared.choice, prepared.selection);
  if (!run.adaptivity.enabled) {
    properties.damping = keep_damping(properties.damping, prepared.available, prepared.selection);
    prepared.available = prepared.selection;
    std::erase_if(properties.stiffened,
                  [&](const std::string& body) { return !prepared.selection.contains(body); });
  }
  return properties;
}

// Finds the free lengths of springs whose static length is given, for the balance with some modes.
void find_free_lengths(const ModalProperties& properties, const ModeSelection& modes, PreparedRun& prepared) {
  prepared.static_lengths = solve_static_lengths(prepared.vehicle, [&](const Vehicle& vehicle) {
    return make_model(vehicle, modes, {prepared.level_road.get(), vehicle.direction, 0.0}, properties.damping,
                      MotionUse::kHeld, properties.stiffened);
  });
}

// The vehicle on level ground.
Model make_balance_model(const ModalProperties& properties, const PreparedRun& prepared) {
  return make_model(prepared.vehicle, prepared.available,
                    {prepared.level_road.get(), prepared.vehicle.direction, 0.0}, properties.damping,
                    prepared.run.start == Run::Start::kSteady ? MotionUse::kMoving : MotionUse::kHeld,
                    properties.stiffened);
}

// "" for none.
void report_remark(std::string remark, const RunRequest& request, PreparedRun& prepared) {
  if (remark.empty()) return;
  if (!request.quiet) support::print(request.streams.err, "remark: {}\n", remark);
  prepared.remarks.push_back(std::move(remark));
}

// Assembles the vehicle and, if the preparation needs it, finds its equilibrium on level ground.
// @return its coordinates
Eigen::VectorXd find_balance(const ModalProperties& properties, Preparation preparation,
                             const RunRequest& request, PreparedRun& prepared) {
  const Run& run = prepared.run;
  const Vehicle& vehicle = prepared.vehicle;
  find_free_lengths(properties, prepared.available, prepared);
  prepared.balance_model = make_balance_model(properties, prepared);
  Eigen::VectorXd q = make_start_positions(prepared.balance_model, vehicle);
  prepared.assembly = assemble_positions(prepared.balance_model, q);
  check_massless_bodies(vehicle, prepared.balance_model, q);
  if (!needs_balance_alone(preparation) && run.start == Run::Start::kAsGiven) return q;
  support::ProgressBar progress("static equilibrium", request.quiet, request.streams.err);
  const auto show = [&progress](int iteration, double step) {
    if (support::interrupt_requested()) throw support::Interrupted("in the static equilibrium");
    progress.update(fmt::format("iteration {}, step {:.1e} of the natural size", iteration, step));
  };
  prepared.equilibrium =
      find_equilibrium(prepared.balance_model, q, show, find_motion(run, prepared.balance_model, q));
  check_steady(run, prepared.balance_model, *prepared.equilibrium);
  for (std::string& remark :
       list_unlikely_balance(vehicle, prepared.balance_model, q, prepared.equilibrium->q))
    report_remark(std::move(remark), request, prepared);
  return prepared.equilibrium->q;
}

// The same; where there is no balance, the error, or a remark before it, tells of wheels that are drawn under
// the road, of bodies on which nothing acts, or that are drawn far from each other.
Eigen::VectorXd find_balance_or_explain(const ModalProperties& properties, Preparation preparation,
                                        const RunRequest& request, PreparedRun& prepared) {
  try {
    return find_balance(properties, preparation, request, prepared);
  } catch (const support::NumericalError& error) {
    const Model model = make_balance_model(properties, prepared);
    Eigen::VectorXd q = make_start_positions(model, prepared.vehicle);
    reject_wheels_under_road(prepared.vehicle, model, q);
    std::string message = error.what();
    for (const std::string& reason :
         {describe_idle_bodies(model), describe_far_element(prepared.vehicle, model, q),
          describe_far_movement(model, assemble_positions(model, q))})
      if (!reason.empty()) message += "; " + reason;
    throw support::NumericalError(message);
  } catch (const support::InputError&) {
    // What is wrong may be another place of the drawing than the one to which the error leads.
    const Model model = make_balance_model(properties, prepared);
    Eigen::VectorXd q = make_start_positions(model, prepared.vehicle);
    report_remark(remark_on_wheel_under_road(prepared.vehicle, model, q), request, prepared);
    report_remark(describe_far_movement(model, assemble_positions(model, q)), request, prepared);
    throw;
  }
}

}  // namespace

std::string describe_static_lengths(const PreparedRun& prepared) {
  std::string text;
  for (const StaticLengthResult& spring : prepared.static_lengths) {
    const std::string found = spring.free_length
                                  ? fmt::format("free length {:.6g} m", *spring.free_length)
                                  : fmt::format("gauge pressure {:.6g} Pa", *spring.gauge_pressure);
    text += fmt::format("{}: {} gives {:.6g} m in balance\n", spring.force, found, spring.length);
  }
  return text;
}

PreparedRun prepare_run(const RunRequest& request, Preparation preparation) {
  PreparedRun prepared;
  read_files(request, preparation, prepared);
  const Vehicle& vehicle = prepared.vehicle;
  prepared.output_points = resolve_output_points(prepared.run, vehicle);
  prepared.level_road = std::make_unique<FlatRoad>();
  prepared.road = make_road(prepared.run.road);
  // Where the statistics contain it, a warning of the run says so.
  const std::string in_statistics =
      describe_missed_road(prepared.run.road, *prepared.road, prepared.run.speed, prepared.run.statistics_to);
  if (preparation == Preparation::kRun && in_statistics.empty()) {
    std::string remark =
        remark_on_road(prepared.run.road, *prepared.road, prepared.run.speed, prepared.run.duration);
    if (!remark.empty())
      remark +=
          fmt::format("; the statistics, up to {:.6g} s, do not contain it", prepared.run.statistics_to);
    report_remark(std::move(remark), request, prepared);
  }
  // Modes are chosen about the balance of the rigid vehicle, if the run asks for a choice.
  if (!list_automatic_bodies(prepared.run.modes).empty()) find_free_lengths({}, {}, prepared);
  const ModalProperties properties = choose_modes(preparation, prepared);
  if (preparation == Preparation::kChoice) return prepared;

  const Eigen::VectorXd q = find_balance_or_explain(properties, preparation, request, prepared);
  SystemTerms terms(prepared.balance_model);
  terms.update_positions(0.0, q);
  prepared.placed_road = {prepared.road.get(), vehicle.direction,
                          find_leading_position(prepared.balance_model, vehicle, terms.markers())};
  prepared.model = make_model(vehicle, prepared.available, prepared.placed_road, properties.damping,
                              MotionUse::kMoving, properties.stiffened);
  for (std::string& remark : list_uncovered_loads(vehicle, prepared.model))
    report_remark(std::move(remark), request, prepared);
  for (std::string& remark : list_spread_loads(vehicle, prepared.model))
    report_remark(std::move(remark), request, prepared);
  IntegratorSettings& integrator = prepared.run.integrator;
  if (!integrator.names_method)
    integrator.options.method = default_method(prepared.model.num_freedoms(), prepared.model.has_modes());
  prepared.start = needs_balance_alone(preparation)
                       ? make_state(prepared.model, q, Eigen::VectorXd::Zero(prepared.model.num_coordinates))
                       : find_start_state(q, prepared);
  if (preparation == Preparation::kRun)
    report_remark(describe_early_end(prepared.run, prepared.start.time), request, prepared);
  return prepared;
}

std::optional<AdaptivityOptions> make_adaptivity(const PreparedRun& prepared, std::optional<Model>& full) {
  const AdaptivitySettings& settings = prepared.run.adaptivity;
  if (!settings.enabled && !settings.indicator) return std::nullopt;
  AdaptivityOptions options;
  options.changes = settings.enabled;
  options.thresholds = settings.thresholds;
  if (settings.enabled) {
    options.full = &prepared.model;
    // The road is level at the start, so the equilibrium on level ground is that on the road.
    const std::optional<Equilibrium>& balance = prepared.equilibrium;
    if (balance && balance->motion.is_rest() && prepared.start.q == balance->q) {
      options.linearised = &balance->linearised;
    }
  } else {
    full = make_model(prepared.vehicle, select_all_modes(prepared.vehicle), prepared.placed_road,
                      keep_single_ratios(prepared.run.modal_damping, prepared.vehicle));
    if (full->num_coordinates == prepared.model.num_coordinates) return std::nullopt;
    options.full = &*full;
    options.missing = find_missing_start(prepared, *full);
  }
  options.judged_from = prepared.run.statistics_from;
  options.judged_to = prepared.run.statistics_to;
  options.continues = !prepared.run.continue_from.empty();
  options.active.assign(static_cast<std::size_t>(options.full->num_coordinates), true);
  for (const Body& body : options.full->bodies) {
    const auto selected = prepared.selection.find(body.name);
    for (int k = 0; k < body.num_modes(); ++k) {
      const int number = body.mode_numbers[static_cast<std::size_t>(k)];
      options.active[static_cast<std::size_t>(body.first_coordinate + 3 + k)] =
          selected != prepared.selection.end() &&
          std::binary_search(selected->second.begin(), selected->second.end(), number);
    }
  }
  if (settings.enabled) activate_moving_modes(prepared.model, prepared.start, options.active);
  if (prepared.vehicle.judged.points) {
    for (const std::string& point : prepared.output_points)
      options.points.push_back(options.full->find_marker(point));
  }
  return options;
}

}  // namespace sprung::dynamics
