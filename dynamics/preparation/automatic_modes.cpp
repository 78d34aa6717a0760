#include "dynamics/preparation/automatic_modes.h"

#include <algorithm>
#include <string>

#include "dynamics/input/make_model.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/preparation/massless_check.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/section_loads/linear_moments.h"

namespace sprung::dynamics {

namespace {

bool is_driven(const Model& moving) {
  return std::any_of(moving.joints.begin(), moving.joints.end(), [](const auto& joint) {
    const std::vector<const TimeFunction*> functions = joint->time_functions();
    return std::any_of(functions.begin(), functions.end(),
                       [](const TimeFunction* f) { return !f->is_constant(); });
  });
}

// The reason why the forcing of a run is not known beforehand; "" if it is known.
std::string find_unknown(const Run& run, const Model& moving) {
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

BasisChoice choose_automatic_modes(const Run& run, const Vehicle& vehicle, const ModeSelection& all,
                                   const ModalDamping& damping, const StiffenedBodies& stiffened,
                                   const Road& road) {
  const FlatRoad level;
  const PlacedRoad placed{&level, vehicle.direction, 0.0};
  const Model model = make_model(vehicle, all, placed, damping, MotionUse::kHeld, stiffened);
  const std::vector<CandidateMode> candidates = list_candidates(run, vehicle, model);
  const double tolerance = run.mode_choice.tolerance;
  const std::string unknown =
      find_unknown(run, make_model(vehicle, all, placed, damping, MotionUse::kMoving, stiffened));
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
  const KnownForcing forcing{.road = &road, .speed = std::max(run.speed, 0.0), .duration = run.duration};
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
