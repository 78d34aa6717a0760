#include "tests/dynamics/truck.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "dynamics/linear/assembly.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/system/system_terms.h"

namespace sprung::test {

using Eigen::VectorXd;
using namespace dynamics;

namespace {

const FlatRoad& flat_road() {
  static const FlatRoad road;
  return road;
}

const BumpRoad& bump_road() {
  static const BumpRoad road({.shape = BumpShape::kHalfSine, .start = 1.0, .length = 0.4, .height = 0.2});
  return road;
}

double heading(const Vehicle& vehicle, bool mirrored) {
  return mirrored ? -vehicle.direction : vehicle.direction;
}

Model make_truck_on(const Vehicle& vehicle, int num_chassis_modes, const PlacedRoad& road, bool mirrored) {
  Model model = make_truck(vehicle, num_chassis_modes, road);
  if (mirrored) mirror_model(model);
  return model;
}

}  // namespace

Vehicle read_truck(const std::vector<std::string>& changes) {
  const std::filesystem::path path = std::filesystem::path(SPRUNG_MODELS) / "truck" / "vehicle.toml";
  support::TomlDocument document = support::TomlDocument::read(path);
  for (const std::string& change : changes) document.set(change, "change");
  return read_vehicle(document, SPRUNG_TRUCK_SUPERELEMENTS);
}

Model make_truck(const Vehicle& vehicle, int num_chassis_modes, const PlacedRoad& road,
                 const ModalDamping& damping) {
  ModeSelection selection;
  if (num_chassis_modes > 0) {
    std::vector<int>& numbers = selection["chassis"];
    numbers.resize(static_cast<std::size_t>(num_chassis_modes));
    std::iota(numbers.begin(), numbers.end(), 1);
  }
  return make_model(vehicle, selection, road, damping);
}

VectorXd assemble_truck(const Model& model, const Vehicle& vehicle, double shift) {
  VectorXd q = make_start_positions(model, vehicle);
  for (const Body& body : model.bodies) q[body.first_coordinate] += shift;
  assemble_positions(model, q);
  return q;
}

void mirror_model(Model& model) {
  for (Body& body : model.bodies) {
    body.first_moment.x() *= -1.0;
    body.P.row(0) *= -1.0;
    body.c *= -1.0;
    body.B *= -1.0;
  }
  for (Marker& marker : model.markers) {
    marker.p_BP.x() *= -1.0;
    marker.Phi.row(0) *= -1.0;
    marker.Phi.row(2) *= -1.0;
  }
}

VectorXd mirror_coordinates(const Model& model, const VectorXd& q) {
  VectorXd mirrored = q;
  for (const Body& body : model.bodies) {
    mirrored[body.first_coordinate] *= -1.0;
    mirrored[body.first_coordinate + 2] *= -1.0;
  }
  return mirrored;
}

TruckAtRest::TruckAtRest(int num_chassis_modes, double shift, bool mirrored)
    : vehicle(read_truck()),
      model(make_truck_on(vehicle, num_chassis_modes, {&flat_road(), heading(vehicle, mirrored), 0.0},
                          mirrored)) {
  VectorXd q = make_start_positions(model, vehicle);
  for (const Body& body : model.bodies) q[body.first_coordinate] += shift;
  if (mirrored) q = mirror_coordinates(model, q);
  assemble_positions(model, q);
  equilibrium = find_equilibrium(model, q);
}

VectorXd TruckAtRest::chassis() const {
  return equilibrium.q.segment<3>(
      model.bodies[static_cast<std::size_t>(model.find_body("chassis"))].first_coordinate);
}

void EnergyClosure::add(const EnergyBook& book) {
  if (!has_first_) first_ = book;
  has_first_ = true;
  const Energy& now = book.stored;
  const Energy& then = first_.stored;
  largest_change_ = std::max(largest_change_,
                             std::abs(now.kinetic - then.kinetic) + std::abs(now.strain - then.strain) +
                                 std::abs(now.gravity - then.gravity) + std::abs(now.spring - then.spring));
  largest_error_ =
      std::max(largest_error_, std::abs(now.total() - then.total() + book.dissipated - book.input));
}

namespace {

// Where the front axle's centre is along the direction of travel.
double leading_position(const TruckAtRest& rest, double direction) {
  SystemTerms terms(rest.model);
  terms.update_positions(0.0, rest.equilibrium.q);
  const int front_axle = rest.model.find_marker("front_axle.origin");
  return direction * terms.markers()[static_cast<std::size_t>(front_axle)].r.x();
}

}  // namespace

BumpStart::BumpStart(const BumpRun& run)
    : rest(run.num_chassis_modes, run.shift, run.mirrored),
      direction(heading(rest.vehicle, run.mirrored)),
      model(make_truck_on(rest.vehicle, run.num_chassis_modes,
                          {&bump_road(), direction, leading_position(rest, direction)}, run.mirrored)),
      state{.time = 0.0,
            .q = rest.equilibrium.q,
            .v = VectorXd::Zero(model.num_coordinates),
            .branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))} {
  for (const Body& body : model.bodies) state.v[body.first_coordinate] = 3.0 * direction;
}

BumpResult drive_over_bump(const BumpRun& run) {
  const BumpStart start(run);
  const Model& model = start.model;
  BumpResult result;
  EnergyClosure closure;
  const VectorXd balance = start.rest.chassis();
  const int chassis = model.bodies[static_cast<std::size_t>(model.find_body("chassis"))].first_coordinate;
  VectorXd phi(model.num_constraints);
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> accelerations;
  TransientOptions options;
  options.end_time = run.duration;
  options.integrator = {.method = run.method, .relative_tolerance = run.relative_tolerance};
  options.on_event = [&](const Event& event) { result.events.push_back(event); };
  options.on_output = [&](const Snapshot& snapshot) {
    const VectorXd& q = snapshot.q;
    const double mirror = run.mirrored ? -1.0 : 1.0;
    rows.emplace_back(start.direction * (q[chassis] - balance[0]), q[chassis + 1] - balance[1],
                      mirror * q[chassis + 2]);
    accelerations.push_back(snapshot.v_dot[chassis + 1]);
    snapshot.terms().calc_residual(phi);
    result.largest_violation = std::max(result.largest_violation, phi.cwiseAbs().maxCoeff());
    closure.add(snapshot.energy);
  };
  result.statistics = run_transient(model, start.state, options);
  result.chassis.resize(3, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) result.chassis.col(static_cast<Eigen::Index>(i)) = rows[i];
  result.acceleration =
      Eigen::Map<const VectorXd>(accelerations.data(), static_cast<Eigen::Index>(accelerations.size()));
  result.lowest = result.chassis.row(1).minCoeff();
  result.highest = result.chassis.row(1).maxCoeff();
  result.closure = closure.value();
  return result;
}

}  // namespace sprung::test
