#include "dynamics/section_loads/linear_moments.h"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "dynamics/section_loads/vehicle_sections.h"

namespace sprung::dynamics {

namespace {

constexpr double kEqualMoments = 1e-6;  // relative difference
constexpr double kRounding = 1e-9;  // of the largest moment of any mode: that of a mode which does not bend

// A place of a body where moments are watched.
struct MomentPlace {
  std::size_t sections;  // of the body, among those of the vehicle
  Eigen::Index station;
};

// For each mode that bends the body the stations at which its bending moment is the largest: all of them
// where rounding would choose between equal ones.
std::vector<Eigen::Index> choose_stations(const Body& body, const reduce::Superelement& superelement) {
  const Eigen::Index num_stations = superelement.resultants.rows() / 3;
  const Eigen::MatrixXd moments =
      superelement.resultants(Eigen::seqN(2, num_stations, 3), Eigen::all).cwiseAbs();
  const double rounding = kRounding * moments.maxCoeff();
  std::set<Eigen::Index> stations;
  for (const int number : body.mode_numbers) {
    const auto sizes = moments.col(number - 1);
    const double largest = sizes.maxCoeff();
    for (Eigen::Index station = 0; station < num_stations && largest > rounding; ++station) {
      if (sizes[station] >= (1.0 - kEqualMoments) * largest) stations.insert(station);
    }
  }
  return {stations.begin(), stations.end()};
}

std::vector<MomentPlace> list_places(const VehicleSections& sections, const Model& model,
                                     const Vehicle& vehicle) {
  std::vector<MomentPlace> places;
  for (std::size_t s = 0; s < sections.bodies().size(); ++s) {
    if (!sections.bodies()[s].has_modes()) continue;
    const std::size_t body = sections.bodies()[s].body();
    for (const Eigen::Index station :
         choose_stations(model.bodies[body], *vehicle.superelement_of(vehicle.bodies[body]))) {
      places.push_back({s, station});
    }
  }
  return places;
}

Eigen::VectorXd pick_moments(const VehicleSections& sections, const std::vector<MomentPlace>& places) {
  Eigen::VectorXd moments(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const BodySections& body = sections.bodies()[places[i].sections];
    const Eigen::Matrix3Xd& values = body.has_loads() ? body.from_loads() : body.from_modes();
    moments[static_cast<Eigen::Index>(i)] = values(2, places[i].station);
  }
  return moments;
}

// Effects of forces and loads on the moments: these are linear in loads and accelerations.
void add_direct_effects(const LinearVehicle& linear, const std::vector<MomentPlace>& places,
                        VehicleSections& sections, LinearOutputs& outputs) {
  const SystemTerms& terms = linear.equations().terms();
  const Model& model = linear.model();
  const Eigen::VectorXd& q = linear.positions();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model.num_coordinates);
  const auto moments_of = [&](std::span<const Wrench> loads, const Eigen::VectorXd& v_dot) {
    sections.update(loads, q, rest, v_dot);
    return pick_moments(sections, places);
  };
  const std::vector<Wrench> none(model.markers.size());
  std::vector<Wrench> loads(model.markers.size());
  const Eigen::VectorXd unloaded = moments_of(none, rest);
  terms.calc_loads(Eigen::VectorXd::Zero(model.num_constraints), loads);
  const Eigen::VectorXd at_rest = moments_of(loads, rest);
  const ForceEffects effects = calc_force_effects(linear);
  for (Eigen::Index i = 0; i < model.num_coordinates; ++i) {
    terms.calc_loads(effects.multipliers.col(i), loads);
    outputs.by_force.col(i) = moments_of(loads, effects.accelerations.col(i)) - at_rest;
  }
  for (const int marker : model.acting_markers) {
    for (int component = 0; component < 3; ++component) {
      loads = none;
      Wrench& load = loads[static_cast<std::size_t>(marker)];
      (component == 2 ? load.torque : load.force[component]) = 1.0;
      outputs.by_load.col(3 * marker + component) = moments_of(loads, rest) - unloaded;
    }
  }
}

}  // namespace

LinearOutputs make_moment_outputs(const LinearVehicle& linear, const Vehicle& vehicle) {
  VehicleSections sections(vehicle, linear.model());
  const std::vector<MomentPlace> places = list_places(sections, linear.model(), vehicle);
  if (places.empty()) return {};
  LinearOutputs outputs = make_state_outputs(
      linear, [&](const PartitionedEquations& at, std::span<const int> /*branches*/) -> Eigen::VectorXd {
        sections.update(at.terms(), at.multipliers(), at.q(), at.v(), at.v_dot());
        return pick_moments(sections, places);
      });
  add_direct_effects(linear, places, sections, outputs);
  for (const MomentPlace& place : places) {
    const BodySections& body = sections.bodies()[place.sections];
    outputs.names.push_back(fmt::format("bodies/{}/moment.{}", body.name(), place.station));
    outputs.units.emplace_back("N m");
    outputs.subjects.push_back(
        {.kind = OutputSubject::Kind::kMoment, .object = static_cast<int>(body.body())});
  }
  return outputs;
}

}  // namespace sprung::dynamics
