// The fast evaluator of the equations against the plain one, on general states of the flexible truck.
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <numbers>

#include "dynamics/road/bump_road.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/system/dense_comparison.h"
#include "tests/dynamics/truck.h"

using namespace sprung;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The whole vehicle turned about the world's origin and moved: joints stay closed.
VectorXd move_rigidly(const dynamics::Model& model, const VectorXd& q, double angle,
                      const Eigen::Vector2d& shift) {
  VectorXd moved = q;
  const Eigen::Rotation2Dd turn(angle);
  for (const dynamics::Body& body : model.bodies) {
    moved.segment<2>(body.first_coordinate) = turn * q.segment<2>(body.first_coordinate) + shift;
    moved[body.first_coordinate + 2] += angle;
  }
  return moved;
}

// Changes of coordinates or rates: `length` for positions, 1/3 of it in rad for angles; modes bend by up to
// `bending`.
VectorXd random_change(const dynamics::Model& model, test::RandomNumbers& random, double length,
                       double bending) {
  VectorXd change(model.num_coordinates);
  for (const dynamics::Body& body : model.bodies) {
    const Index first = body.first_coordinate;
    change.segment<2>(first) = random.vector(2, length);
    change[first + 2] = random.size_up_to(length / 3.0);
    for (Index k = 0; k < body.num_modes(); ++k) {
      change[first + 3 + k] = random.size_up_to(bending / body.mode_scale[k] / static_cast<double>(1 + k));
    }
  }
  return change;
}

struct Comparison {
  test::EvaluatorDifference worst;
  bool all_nonzero = true;
  std::map<int, int> suspension_pieces, damper_pieces, contacts;  // how often each branch was met
};

Comparison compare_on_truck(int num_modes, int num_states, std::uint64_t seed) {
  const dynamics::Vehicle vehicle = test::read_truck();
  // A road that is nowhere level under the truck.
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = -30.0, .length = 40.0, .height = 0.05});
  const dynamics::Model model = test::make_truck(vehicle, num_modes, {&road, -1.0, 1.0});
  const VectorXd at_rest = test::assemble_truck(model, vehicle);
  test::RandomNumbers random(seed);
  Comparison comparison;
  for (int i = 0; i < num_states; ++i) {
    // Every third state is the truck tumbling in the air; the others are near their wheels.
    const bool tumbles = i % 3 == 0;
    const double angle = tumbles ? random.size_up_to(std::numbers::pi) : random.size_up_to(0.01);
    const Eigen::Vector2d shift(random.size_up_to(2.0), tumbles ? 20.0 : random.between(0.0, 0.06));
    const VectorXd assembled = move_rigidly(model, at_rest, angle, shift);
    const VectorXd q = assembled + random_change(model, random, 0.08, 0.02);
    const VectorXd v = random_change(model, random, 3.0, 1.0);
    dynamics::State state;
    const test::EvaluatorDifference difference = test::compare_evaluators(model, assembled, q, v, state);
    if (difference.largest() > comparison.worst.largest()) comparison.worst = difference;
    comparison.all_nonzero &= (state.q.array() != 0.0).all() && (state.v.array() != 0.0).all();
    for (std::size_t force = 0; force < model.forces.size(); ++force) {
      const auto first = static_cast<std::size_t>(model.force_branches[force]);
      if (model.forces[force]->kind() == "tyre") {
        ++comparison.contacts[state.branches[first]];
      } else {
        ++comparison.suspension_pieces[state.branches[first]];
        ++comparison.damper_pieces[state.branches[first + 1]];
      }
    }
  }
  return comparison;
}

}  // namespace

TEST_CASE("The fast and the plain evaluator agree on general states of the flexible truck", "[truck]") {
  for (const int num_modes : {0, 2, 4, 12, 36}) {
    const Comparison comparison =
        compare_on_truck(num_modes, 400, 1000 + static_cast<std::uint64_t>(num_modes));
    INFO(num_modes << " modes: position " << comparison.worst.position << ", velocity "
                   << comparison.worst.velocity << ", acceleration " << comparison.worst.acceleration
                   << ", multiplier " << comparison.worst.multiplier << ", kinetic energy "
                   << comparison.worst.kinetic_energy);
    CHECK(comparison.worst.largest() < 1e-9);
    CHECK(comparison.all_nonzero);
    // Every formula of the forces was met: both pieces of the spring and of the damper; air, contact, clipped
    // contact.
    CHECK(comparison.suspension_pieces.size() == 2);
    CHECK(comparison.damper_pieces.size() == 2);
    CHECK(comparison.contacts.size() == 3);
    for (const auto* counts :
         {&comparison.suspension_pieces, &comparison.damper_pieces, &comparison.contacts}) {
      for (const auto& [branch, count] : *counts) {
        INFO("branch " << branch);
        CHECK(count >= 5);
      }
    }
  }
}

TEST_CASE("A force that goes over to another formula changes all as evaluating anew would", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck();
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = -30.0, .length = 40.0, .height = 0.05});
  const dynamics::Model model = test::make_truck(vehicle, 4, {&road, -1.0, 1.0});
  test::RandomNumbers random(8);
  const VectorXd q = test::assemble_truck(model, vehicle), v = random_change(model, random, 3.0, 1.0);
  dynamics::PartitionedEquations changed(model), anew(model);
  std::vector<double> q_i, v_i;
  for (dynamics::PartitionedEquations* equations : {&changed, &anew}) {
    equations->choose_partition_at(0.0, q);
    q_i.clear(), v_i.clear();
    for (const int i : equations->partition().independent) q_i.push_back(q[i]), v_i.push_back(v[i]);
    REQUIRE(equations->update_positions(0.0, q_i) == dynamics::PartitionedEquations::Outcome::kGood);
    equations->update_velocities(v_i);
  }
  std::vector<int> branches(static_cast<std::size_t>(model.num_branches));
  changed.terms().choose_branches(branches);
  changed.update_accelerations(branches);
  const auto loads_of = [&](const dynamics::PartitionedEquations& equations) {
    std::vector<dynamics::Wrench> loads(model.markers.size());
    equations.terms().calc_loads(equations.multipliers(), loads);
    VectorXd numbers(3 * static_cast<Index>(loads.size()));
    for (std::size_t i = 0; i < loads.size(); ++i)
      numbers.segment<3>(3 * static_cast<Index>(i)) << loads[i].force, loads[i].torque;
    return numbers;
  };
  int num_changed = 0;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    if (model.forces[f]->kind() == "tyre") continue;
    INFO(model.forces[f]->name);
    const auto first = static_cast<std::size_t>(model.force_branches[f]);
    const std::vector<int> from{branches[first], branches[first + 1]}, to{from[0], 1 - from[1]};
    branches[first + 1] = to[1];
    const VectorXd before = changed.v_dot();
    const dynamics::Power old_power = changed.terms().power();
    const dynamics::Power power = changed.change_branches(f, from, to);
    anew.update_accelerations(branches);
    const double size = anew.v_dot().norm();
    CHECK((anew.v_dot() - before).norm() > 1e-3 * size);
    CHECK((changed.v_dot() - anew.v_dot()).norm() < 1e-11 * size);
    CHECK((changed.change_of_v_dot() - (anew.v_dot() - before)).norm() < 1e-11 * size);
    CHECK((changed.multipliers() - anew.multipliers()).norm() < 1e-11 * anew.multipliers().norm());
    CHECK((loads_of(changed) - loads_of(anew)).norm() < 1e-11 * loads_of(anew).norm());
    CHECK(changed.terms().power().dissipated == Approx(anew.terms().power().dissipated).epsilon(1e-11));
    CHECK(old_power.dissipated + power.dissipated == Approx(anew.terms().power().dissipated).epsilon(1e-11));
    ++num_changed;
  }
  CHECK(num_changed >= 2);
}
