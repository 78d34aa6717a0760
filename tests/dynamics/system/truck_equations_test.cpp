// The fast evaluator of the equations against the plain one, on general states of the flexible truck.
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/system/energy.h"
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
  // A road that is level nowhere under the truck.
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

TEST_CASE("Parts of the kinetic energy add up to it, and forward motion changes only the first", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck();
  const dynamics::FlatRoad road;
  const dynamics::Model model = test::make_truck(vehicle, 4, {&road, -1.0, 1.0});
  test::RandomNumbers random(7);
  dynamics::SystemTerms terms(model);
  terms.update_positions(0.0, test::assemble_truck(model, vehicle));
  terms.update_mass();
  VectorXd v = random_change(model, random, 3.0, 1.0);
  terms.update_velocities(v);
  VectorXd parts, faster;
  dynamics::calc_kinetic_parts(terms, parts);
  std::vector<int> branches(static_cast<std::size_t>(model.num_branches));
  terms.choose_branches(branches);
  const double kinetic = dynamics::calc_energy(terms, branches).kinetic;
  CHECK(std::abs(parts.sum() - kinetic) < 1e-12 * kinetic);
  CHECK(parts.minCoeff() > 0.0);

  for (const dynamics::Body& body : model.bodies) v[body.first_coordinate] += 20.0;
  terms.update_velocities(v);
  dynamics::calc_kinetic_parts(terms, faster);
  CHECK(faster[0] > parts[0] + kinetic);
  CHECK((faster - parts).tail(parts.size() - 1).lpNorm<Eigen::Infinity>() < 1e-12 * faster[0]);
}
