// Models of the truck with held modes against the full one: motion, forces, momentum and energy of leaving
// modes.
#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "dynamics/adaptivity/full_motion.h"
#include "dynamics/adaptivity/full_small_motion.h"
#include "dynamics/adaptivity/unbalanced_force.h"
#include "dynamics/linear/linearisation.h"
#include "dynamics/system/energy.h"
#include "dynamics/system/held_modes.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/truck.h"

using namespace sprung;

TEST_CASE("A model with held modes moves as the full one with these modes at rest", "[truck]") {
  const test::TruckAtRest rest(6);
  const dynamics::Model& full = rest.model;
  Eigen::VectorXd q = rest.equilibrium.q;
  std::vector<bool> is_active(static_cast<std::size_t>(full.num_coordinates), true);
  const dynamics::Body& body = full.bodies[static_cast<std::size_t>(full.find_body("chassis"))];
  for (const int k : {1, 2, 5}) {
    is_active[static_cast<std::size_t>(body.first_coordinate + 3 + k)] = false;
    q[body.first_coordinate + 3 + k] = 0.3 * (k + 1);  // bent by centimetres
  }
  const dynamics::HeldModes held = dynamics::hold_modes(full, is_active, q);
  REQUIRE(held.model.num_coordinates == full.num_coordinates - 3);

  Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(full.num_coordinates, -0.5, 0.8);
  for (const int k : {1, 2, 5}) v[body.first_coordinate + 3 + k] = 0.0;
  dynamics::SystemTerms of_full(full), of_held(held.model);
  const auto update = [](dynamics::SystemTerms& terms, const Eigen::VectorXd& at,
                         const Eigen::VectorXd& rate) {
    terms.update_positions(0.0, at);
    terms.update_jacobian();
    terms.update_mass();
    terms.update_velocities(rate);
    std::vector<int> branches(static_cast<std::size_t>(terms.model().num_branches));
    terms.choose_branches(branches);
    terms.update_forces(branches);
  };
  update(of_full, q, v);
  update(of_held, select_active(held, q), select_active(held, v));
  CHECK((of_held.forces() - select_active(held, of_full.forces())).norm() < 1e-9 * of_full.forces().norm());
  for (std::size_t i = 0; i < full.markers.size(); ++i) {
    CHECK((of_held.markers()[i].r - of_full.markers()[i].r).norm() < 1e-12);
    CHECK((of_held.markers()[i].v - of_full.markers()[i].v).norm() < 1e-12);
    CHECK(of_held.markers()[i].angle == Approx(of_full.markers()[i].angle).margin(1e-13));
  }
  Eigen::VectorXd gamma_full(full.num_constraints), gamma_held(full.num_constraints);
  of_full.calc_gamma(gamma_full);
  of_held.calc_gamma(gamma_held);
  CHECK((gamma_full - gamma_held).norm() < 1e-10 * gamma_full.norm());
  const auto chassis = static_cast<std::size_t>(full.find_body("chassis"));
  const std::vector<int> rows{0, 1, 2, 3, 6, 7};
  CHECK((of_held.mass(chassis) - of_full.mass(chassis)(rows, rows)).norm() <
        1e-12 * of_full.mass(chassis).norm());
}

TEST_CASE("Small motion with held modes is that of the full model without them", "[truck]") {
  const test::TruckAtRest rest(6);
  const dynamics::Model& full = rest.model;
  std::vector<bool> is_active(static_cast<std::size_t>(full.num_coordinates), true);
  const dynamics::Body& body = full.bodies[static_cast<std::size_t>(full.find_body("chassis"))];
  for (const int k : {1, 2, 5}) is_active[static_cast<std::size_t>(body.first_coordinate + 3 + k)] = false;
  const dynamics::HeldModes held = dynamics::hold_modes(full, is_active, rest.equilibrium.q);
  const dynamics::FullSmallMotion motion(full, 0.0, rest.equilibrium.q, {}, nullptr);
  const std::optional<dynamics::KnownMotion> known = motion.calc_held_motion(held);
  REQUIRE(known);

  dynamics::PartitionedEquations equations(held.model);
  const dynamics::LinearisedSystem expected =
      linearise(equations, 0.0, select_active(held, rest.equilibrium.q));
  REQUIRE(known->independent == expected.partition.independent);
  CHECK((known->motion.mass - expected.mass).norm() < 1e-9 * expected.mass.norm());
  CHECK((known->motion.damping - expected.damping).norm() < 1e-6 * expected.damping.norm());
  CHECK((known->motion.stiffness - expected.stiffness).norm() < 1e-6 * expected.stiffness.norm());

  // A linearisation that is given is used as it is.
  dynamics::LinearisedSystem other = rest.equilibrium.linearised;
  other.stiffness *= 2.0;
  const dynamics::FullSmallMotion informed(full, 0.0, rest.equilibrium.q, {}, &other);
  CHECK((informed.calc_held_motion(held)->motion.stiffness - 2.0 * known->motion.stiffness).norm() <
        1e-6 * expected.stiffness.norm());
}

namespace {

// The truck bent and moving at random, joints closed, with some modes of the chassis held.
struct MovingTruck {
  explicit MovingTruck(const std::vector<int>& held_modes)
      : rest(6), full(&rest.model), is_active(rest.model.num_coordinates, true) {
    dynamics::ConstrainedEquations equations(*full, dynamics::SystemTerms::Markers::kAll);
    const dynamics::Body& body = full->bodies[static_cast<std::size_t>(full->find_body("chassis"))];
    Eigen::VectorXd bent = rest.equilibrium.q;
    for (int k = 0; k < 6; ++k) bent[body.first_coordinate + 3 + k] += 0.2 - 0.07 * k;
    REQUIRE(equations.close_joints(0.0, bent));
    q = equations.q();
    equations.close_rates(Eigen::VectorXd::LinSpaced(full->num_coordinates, -0.5, 0.8));
    v = equations.v();
    for (const int k : held_modes) {
      coordinates.push_back(body.first_coordinate + 3 + k);
      is_active[static_cast<std::size_t>(coordinates.back())] = false;
    }
  }
  test::TruckAtRest rest;
  const dynamics::Model* full;
  std::vector<bool> is_active;
  std::vector<int> coordinates;
  Eigen::VectorXd q, v;
};

Eigen::VectorXd multiply_mass(const dynamics::Model& model, const dynamics::SystemTerms& terms,
                              const Eigen::VectorXd& x) {
  Eigen::VectorXd product(x.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const dynamics::Body& body = model.bodies[b];
    product.segment(body.first_coordinate, body.num_coordinates()) =
        terms.mass(b) * x.segment(body.first_coordinate, body.num_coordinates());
  }
  return product;
}

void update_terms(dynamics::SystemTerms& terms, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  terms.update_positions(0.0, q);
  terms.update_jacobian();
  terms.update_mass();
  terms.update_velocities(v);
}

}  // namespace

TEST_CASE("The unbalanced force on held modes is that of the full model's equations", "[truck]") {
  const MovingTruck truck({1, 2, 5});
  const dynamics::HeldModes held = dynamics::hold_modes(*truck.full, truck.is_active, truck.q);
  Eigen::VectorXd v = truck.v;
  for (const int i : truck.coordinates) v[i] = 0.0;

  // Whatever the accelerations and multipliers are.
  dynamics::SystemTerms of_held(held.model), of_full(*truck.full);
  update_terms(of_held, select_active(held, truck.q), select_active(held, v));
  update_terms(of_full, truck.q, v);
  std::vector<int> branches(static_cast<std::size_t>(truck.full->num_branches));
  of_full.choose_branches(branches);
  of_held.update_forces(branches);
  of_full.update_forces(branches);
  const Eigen::VectorXd lambda = Eigen::VectorXd::LinSpaced(truck.full->num_constraints, -3e4, 5e4);
  Eigen::VectorXd v_dot = Eigen::VectorXd::LinSpaced(truck.full->num_coordinates, 40.0, -30.0);
  for (const int i : truck.coordinates) v_dot[i] = 0.0;

  Eigen::VectorXd expected = of_full.forces() - multiply_mass(*truck.full, of_full, v_dot), reaction;
  reaction = Eigen::VectorXd::Zero(expected.size());
  of_full.jacobian().add_transposed_product(lambda, reaction);
  expected -= reaction;
  dynamics::UnbalancedForce unbalanced(*truck.full);
  unbalanced.update(of_held, lambda, truck.q, v, v_dot);
  for (const int i : truck.coordinates) {
    CHECK(unbalanced.force()[i] == Approx(expected[i]).epsilon(1e-10).margin(1e-10 * reaction.norm()));
  }
}

TEST_CASE("Modes that leave take only their own momentum with them, and the reported energy", "[truck]") {
  const MovingTruck truck({1, 3, 4});
  dynamics::FullMotion motion(*truck.full, {.time = 0.0, .q = truck.q, .v = truck.v, .branches = {}});
  dynamics::SystemTerms terms(*truck.full);
  update_terms(terms, truck.q, truck.v);
  std::vector<int> branches(static_cast<std::size_t>(truck.full->num_branches));
  terms.choose_branches(branches);
  const double kinetic = calc_energy(terms, branches).kinetic;
  const Eigen::VectorXd momentum = multiply_mass(*truck.full, terms, truck.v);

  const dynamics::HeldModes held = motion.hold(truck.is_active);
  const double lost = motion.stop(truck.coordinates, held, 0.0, branches);
  CHECK((motion.q() - truck.q).norm() < 1e-10);
  for (const int i : truck.coordinates) CHECK(motion.v()[i] == 0.0);
  update_terms(terms, motion.q(), motion.v());
  CHECK(lost > 0.0);
  CHECK(kinetic - calc_energy(terms, branches).kinetic == Approx(lost).epsilon(1e-9));
  Eigen::VectorXd opening = Eigen::VectorXd::Zero(truck.full->num_constraints);
  terms.jacobian().add_product(motion.v(), opening);
  CHECK(opening.norm() < 1e-10 * momentum.norm());

  // The change of the others' momentum is an impulse of the joints: it lies in the range of φ_qᵀ on their
  // rows.
  const Eigen::VectorXd change =
      select_active(held, momentum - multiply_mass(*truck.full, terms, motion.v()));
  Eigen::MatrixXd joints(change.size(), truck.full->num_constraints);
  for (Eigen::Index k = 0; k < joints.cols(); ++k) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(truck.full->num_coordinates);
    terms.jacobian().add_transposed_product(Eigen::VectorXd::Unit(joints.cols(), k), column);
    joints.col(k) = select_active(held, column);
  }
  const Eigen::VectorXd impulse = joints.colPivHouseholderQr().solve(change);
  CHECK((joints * impulse - change).norm() < 1e-9 * change.norm());
  CHECK(change.norm() > 1e-3 * momentum.norm());
}
