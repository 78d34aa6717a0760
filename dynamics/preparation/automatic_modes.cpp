#include "dynamics/preparation/automatic_modes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/input/make_model.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/preparation/massless_check.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/section_loads/linear_moments.h"

namespace sprung::dynamics {

namespace {

constexpr double kDrive = 40.0;      // s: four periods of the lowest frequency by default, 0.1 Hz
constexpr double kEased = 0.05;      // of the length, at either end
constexpr double kLeastWaves = 2.0;  // in the range of frequencies

bool is_driven(const Model& moving) {
  return std::any_of(moving.joints.begin(), moving.joints.end(), [](const auto& joint) {
    const std::vector<const TimeFunction*> functions = joint->time_functions();
    return std::any_of(functions.begin(), functions.end(),
                       [](const TimeFunction* f) { return !f->is_constant(); });
  });
}

// The reason why the forcing is not known beforehand; "" if it is known.
std::string find_unknown(const Run& run, const RoadOfChoice& road, const Model& moving) {
  if (!road.road) return "no wave of response.road lies in the range of frequencies";
  if (road.is_of_response) return "";
  if (run.start != Run::Start::kEquilibrium) return "the run does not start in static equilibrium";
  if (is_driven(moving)) return "prescribed motion drives the vehicle";
  if (!run.initial.empty()) return "[initial] adds motion at the start";
  if (!run.joint_rates.empty()) return "[joint_rates] adds motion at the start";
  if (run.speed < 0.0 && run.road.shape != "flat") return "the vehicle drives backwards over the road";
  return "";
}

std::vector<CandidateMode> list_candidates(const Run& run, const Vehicle& vehicle, const Model& model) {
  const std::vector<std::string> automatic = list_automatic_bodies(run.modes);
  std::vector<CandidateMode> candidates;
  for (const Body& body : model.bodies) {
    if (std::find(automatic.begin(), automatic.end(), body.name) == automatic.end()) continue;
    const reduce::Superelement& superelement = *vehicle.superelement_of(*vehicle.find_body(body.name));
    for (int k = 0; k < body.num_modes(); ++k) {
      const int number = body.mode_numbers[static_cast<std::size_t>(k)];
      candidates.push_back({.body = body.name,
                            .number = number,
                            .frequency_hz = superelement.frequency_hz[number - 1],
                            .cluster = superelement.cluster[number - 1],
                            .coordinate = body.first_coordinate + 3 + k});
    }
  }
  return candidates;
}

}  // namespace

RoadOfChoice make_road_of_run(const Run& run) {
  return {.road = make_road(run.road), .duration = run.duration};
}

RoadOfChoice make_road_of_response(const Run& run) {
  const double from = run.response.from, to = run.response.to;
  const double duration = std::max(kDrive, kLeastWaves / (to - from));
  RandomRoad random{.spectrum = *run.response.road,
                    .lowest = from / run.speed,
                    .highest = to / run.speed,
                    .length = run.speed * duration};
  random.ease = kEased * random.length;
  // The waves of such a road are whole parts of its length.
  bool has_waves = false;
  for (double k = std::ceil(from * duration); k <= to * duration; ++k)
    has_waves = has_waves || random.spectrum.density(k / random.length) > 0.0;
  RoadOfChoice choice{.road = nullptr, .duration = duration, .is_of_response = true};
  if (!has_waves) return choice;
  RoadDescription description;
  description.shape = "random";
  description.random = random;
  description.location = run.response.location;
  choice.road = make_road(description);
  return choice;
}

BasisChoice choose_automatic_modes(const Run& run, const Vehicle& vehicle, const ModeSelection& all,
                                   const ModalDamping& damping, const StiffenedBodies& stiffened,
                                   const RoadOfChoice& road) {
  const FlatRoad level;
  const PlacedRoad placed{&level, vehicle.direction, 0.0};
  const Model model = make_model(vehicle, all, placed, damping, MotionUse::kHeld, stiffened);
  const std::vector<CandidateMode> candidates = list_candidates(run, vehicle, model);
  const double tolerance = run.mode_choice.tolerance;
  const std::string unknown =
      find_unknown(run, road, make_model(vehicle, all, placed, damping, MotionUse::kMoving, stiffened));
  if (!unknown.empty()) return keep_all(candidates, tolerance, unknown);

  Eigen::VectorXd q = make_start_positions(model, vehicle);
  assemble_positions(model, q);
  check_massless_bodies(vehicle, model, q);
  const Equilibrium equilibrium = find_equilibrium(model, q);
  const LinearVehicle linear(model, equilibrium.q);
  if (!equilibrium.stable || has_growth(linear.solver().eigenvalues())) {
    return keep_all(candidates, tolerance, "the static equilibrium is unstable");
  }
  JudgedPlaces places;
  for (const std::string& name : resolve_output_points(run, vehicle)) {
    const int marker = model.find_marker(name);
    if (model.markers[static_cast<std::size_t>(marker)].body != kGround) places.points.push_back(marker);
  }
  if (vehicle.judged.moments) places.moments = make_moment_outputs(linear, vehicle);
  const KnownForcing forcing{.road = road.road.get(),
                             .speed = std::max(run.speed, 0.0),
                             .duration = road.duration,
                             .is_road_alone = road.is_of_response};
  BasisChoice choice = choose_basis(linear, candidates, places, vehicle.judged, forcing, tolerance);
  for (const RoadInput& input : linear.inputs()) {
    if (!input.is_pressed)
      choice.remarks.push_back("'" + input.name +
                               "' is off the ground in static equilibrium: the road does not act on it");
  }
  return choice;
}

ModeSelection keep_modes(const BasisChoice& choice, ModeSelection all) {
  for (const ModeVerdict& verdict : choice.verdicts) {
    if (verdict.is_kept) continue;
    const auto body = all.find(verdict.mode.body);
    std::erase(body->second, verdict.mode.number);
    if (body->second.empty()) all.erase(body);
  }
  return all;
}

}  // namespace sprung::dynamics
