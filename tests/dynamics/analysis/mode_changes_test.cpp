// Modes that join and leave on the truck: what is held, what is missed, what is carried over.
#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/analysis/full_motion.h"
#include "dynamics/analysis/linearisation.h"
#include "dynamics/analysis/mode_indicator.h"
#include "dynamics/analysis/transient.h"
#include "dynamics/analysis/unbalanced_force.h"
#include "dynamics/forces/applied_force.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/system/held_modes.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"
#include "tests/dynamics/truck.h"

using namespace sprung;

namespace {

struct AdaptiveRun {
  Eigen::VectorXd origin, deflection;  // vertical acceleration of the middle, of the front end's deflection [m/s², m]
  std::vector<dynamics::Event> changes;
  dynamics::TransientStatistics statistics;
  double closure = 0.0;
};

// The bump with all modes of the chassis at hand; num_start of them at the start, none joining where recall is 0.
AdaptiveRun drive(int num_available, int num_start, double recall, double duration) {
  const test::BumpStart bump({.num_chassis_modes = num_available, .duration = duration});
  AdaptiveRun run;
  dynamics::TransientOptions options;
  options.end_time = duration;
  options.integrator.relative_tolerance = 1e-6;
  const int chassis = bump.model.find_body("chassis");
  const dynamics::Body& body = bump.model.bodies[static_cast<std::size_t>(chassis)];
  if (recall > 0.0) {
    dynamics::AdaptivityOptions adaptivity;
    adaptivity.full = &bump.model;
    adaptivity.active.assign(static_cast<std::size_t>(bump.model.num_coordinates), true);
    for (int k = num_start; k < num_available; ++k) {
      adaptivity.active[static_cast<std::size_t>(body.first_coordinate + 3 + k)] = false;
    }
    adaptivity.points = {bump.model.find_marker("chassis.origin"), bump.model.find_marker("chassis.front_end")};
    adaptivity.recall = recall;
    adaptivity.drop = std::min(2e-3, 0.2 * recall);
    options.adaptivity = adaptivity;
  }
  std::vector<double> origin, deflection;
  test::EnergyClosure closure;
  const auto front = static_cast<std::size_t>(bump.model.find_marker("chassis.front_end"));
  options.on_output = [&](const dynamics::Snapshot& now) {
    origin.push_back(now.v_dot[body.first_coordinate + 1]);
    const Eigen::Vector2d u =
        bump.model.markers[front].Phi * now.q.segment(body.first_coordinate + 3, body.num_modes());
    deflection.push_back(u.y());
    closure.add(now.energy);
  };
  options.on_event = [&](const dynamics::Event& event) {
    if (event.kind == "modes") run.changes.push_back(event);
  };
  run.statistics = dynamics::run_transient(bump.model, bump.state, options);
  run.origin = Eigen::Map<Eigen::VectorXd>(origin.data(), static_cast<Eigen::Index>(origin.size()));
  run.deflection = Eigen::Map<Eigen::VectorXd>(deflection.data(), static_cast<Eigen::Index>(deflection.size()));
  run.closure = closure.value();
  return run;
}

double peak(const Eigen::VectorXd& x) { return x.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("A model with held modes moves as the full one whose modes stand still", "[truck]") {
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
  const auto update = [](dynamics::SystemTerms& terms, const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
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
  CHECK((of_held.mass(chassis) - of_full.mass(chassis)(rows, rows)).norm() < 1e-12 * of_full.mass(chassis).norm());
}

TEST_CASE("Small motion with held modes is that of the full model without them", "[truck]") {
  const test::TruckAtRest rest(6);
  const dynamics::Model& full = rest.model;
  std::vector<bool> is_active(static_cast<std::size_t>(full.num_coordinates), true);
  const dynamics::Body& body = full.bodies[static_cast<std::size_t>(full.find_body("chassis"))];
  for (const int k : {1, 2, 5}) is_active[static_cast<std::size_t>(body.first_coordinate + 3 + k)] = false;
  const dynamics::HeldModes held = dynamics::hold_modes(full, is_active, rest.equilibrium.q);
  const dynamics::ModeIndicator indicator(full, 0.0, rest.equilibrium.q, {});
  const std::optional<dynamics::KnownMotion> known = indicator.calc_small_motion(held);
  REQUIRE(known);

  dynamics::PartitionedEquations equations(held.model);
  const dynamics::LinearisedSystem expected = linearise(equations, 0.0, select_active(held, rest.equilibrium.q));
  REQUIRE(known->independent == expected.partition.independent);
  CHECK((known->motion.mass - expected.mass).norm() < 1e-9 * expected.mass.norm());
  CHECK((known->motion.damping - expected.damping).norm() < 1e-6 * expected.damping.norm());
  CHECK((known->motion.stiffness - expected.stiffness).norm() < 1e-6 * expected.stiffness.norm());

  // A linearisation that is known already is taken as it is.
  dynamics::LinearisedSystem other = rest.equilibrium.linearised;
  other.stiffness *= 2.0;
  const dynamics::ModeIndicator informed(full, 0.0, rest.equilibrium.q, {}, &other);
  CHECK((informed.calc_small_motion(held)->motion.stiffness - 2.0 * known->motion.stiffness).norm() <
        1e-6 * expected.stiffness.norm());
}

namespace {

// The truck bent and moving at random, joints closed, with some modes of the chassis held.
struct MovingTruck {
  explicit MovingTruck(const std::vector<int>& held_modes) : rest(6), full(&rest.model), is_active(rest.model.num_coordinates, true) {
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

Eigen::VectorXd multiply_mass(const dynamics::Model& model, const dynamics::SystemTerms& terms, const Eigen::VectorXd& x) {
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

TEST_CASE("Modes that leave take only their own momentum with them, and the energy that is told", "[truck]") {
  const MovingTruck truck({1, 3, 4});
  dynamics::FullMotion motion(*truck.full, {.time = 0.0, .q = truck.q, .v = truck.v, .branches = {}});
  dynamics::SystemTerms terms(*truck.full);
  update_terms(terms, truck.q, truck.v);
  std::vector<int> branches(static_cast<std::size_t>(truck.full->num_branches));
  terms.choose_branches(branches);
  const double kinetic = calc_energy(terms, branches).kinetic;
  const Eigen::VectorXd momentum = multiply_mass(*truck.full, terms, truck.v);

  const dynamics::HeldModes held = motion.hold(truck.is_active, 0.0);
  const double lost = motion.stop(truck.coordinates, held, 0.0, branches);
  CHECK((motion.q() - truck.q).norm() < 1e-10);
  for (const int i : truck.coordinates) CHECK(motion.v()[i] == 0.0);
  update_terms(terms, motion.q(), motion.v());
  CHECK(lost > 0.0);
  CHECK(kinetic - calc_energy(terms, branches).kinetic == Approx(lost).epsilon(1e-9));
  Eigen::VectorXd opening = Eigen::VectorXd::Zero(truck.full->num_constraints);
  terms.jacobian().add_product(motion.v(), opening);
  CHECK(opening.norm() < 1e-10 * momentum.norm());

  // What changed the momentum of the others is an impulse of the joints: in the range of φ_qᵀ on their rows.
  const Eigen::VectorXd change = select_active(held, momentum - multiply_mass(*truck.full, terms, motion.v()));
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

TEST_CASE("Over the bump modes join in time: the adaptive run has the full set's peaks", "[truck]") {
  const double duration = 2.0;
  const AdaptiveRun full = drive(36, 36, 0.0, duration);
  const AdaptiveRun adaptive = drive(36, 2, 8e-2, duration);
  const AdaptiveRun two = drive(2, 2, 0.0, duration);
  CHECK(peak(adaptive.origin) == Approx(peak(full.origin)).epsilon(0.02));
  CHECK(peak(adaptive.deflection) == Approx(peak(full.deflection)).epsilon(0.02));
  CHECK(peak(two.origin) < 0.6 * peak(full.origin));
  CHECK(adaptive.statistics.mean_active_modes < 12.0);
  CHECK(adaptive.statistics.stepper.evaluations < full.statistics.stepper.evaluations);
  CHECK(adaptive.closure < 1e-5);
  CHECK(adaptive.changes.size() > 20);
  // Steps in which more was missed were taken back.
  CHECK(adaptive.statistics.worst_neglect.share.worst() > 0.0);
  CHECK(adaptive.statistics.worst_neglect.share.worst() <= 8e-2 * (1.0 + 1e-9));

  SECTION("and comes closer with a smaller threshold") {
    const AdaptiveRun closer = drive(36, 2, 1e-2, duration);
    const double scale = peak(full.deflection);
    CHECK((closer.deflection - full.deflection).cwiseAbs().maxCoeff() < 0.01 * scale);
    CHECK((closer.deflection - full.deflection).norm() < (adaptive.deflection - full.deflection).norm());
    CHECK((closer.origin - full.origin).norm() < 0.5 * (adaptive.origin - full.origin).norm());
    CHECK(closer.statistics.worst_neglect.share.worst() <= 1e-2 * (1.0 + 1e-9));
  }
  SECTION("what is left out for good is told as it was then, not as it would be with what is active at the end") {
    const AdaptiveRun whole = drive(36, 2, 2e-2, 5.0);
    CHECK(whole.statistics.worst_neglect.share.worst() <= 2e-2 * (1.0 + 1e-9));
  }
  SECTION("the same each time") {
    const AdaptiveRun again = drive(36, 2, 8e-2, duration);
    CHECK(again.origin == adaptive.origin);
    CHECK(again.changes.size() == adaptive.changes.size());
  }
}

TEST_CASE("Of a pair of equal frequency only the member joins that the load excites", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck();
  const auto chassis = std::find_if(vehicle.bodies.begin(), vehicle.bodies.end(),
                                    [](const dynamics::BodyDescription& body) { return body.name == "chassis"; });
  const reduce::Superelement& superelement = *vehicle.superelement_of(*chassis);
  constexpr int kNumModes = 12;
  std::vector<int> modes(kNumModes);
  for (int k = 0; k < kNumModes; ++k) modes[static_cast<std::size_t>(k)] = k + 1;
  REQUIRE(superelement.cluster[0] == superelement.cluster[1]);

  // The chassis alone, held at its middle where the modes are clamped, both ends pushed: alike, then against each other.
  for (const double sign : {1.0, -1.0}) {
    dynamics::Model model;
    const int body = test::add_body(model, dynamics::make_flexible_body("chassis", superelement, modes));
    const int ground = test::add_marker(model, dynamics::kGround, {0.4, 0.1});
    model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
        "root", ground, test::add_marker(model, body, {0.0, 0.0}), support::SourceLocation{}, dynamics::make_fixed_joint(0.0)));
    std::vector<int> ends;
    for (const double towards : {-1.0, 1.0}) {
      int end = 0;
      for (int node = 0; node < superelement.num_nodes(); ++node) {
        if (towards * (superelement.node_positions(0, node) - superelement.node_positions(0, end)) > 0.0) end = node;
      }
      ends.push_back(test::add_node_marker(model, body, superelement, end));
      const double size = towards < 0.0 ? 1e4 : sign * 1e4;
      model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
          "push", dynamics::AppliedForce::Parameters{
                      .marker = ends.back(),
                      .axes = dynamics::AppliedForce::Axes::kWorld,
                      .force_x = dynamics::TimeFunction(0.0),
                      .force_y = dynamics::TimeFunction::smooth_step({.before = 0.0, .after = size, .start = 0.05, .end = 0.06}),
                      .torque = dynamics::TimeFunction(0.0)}));
    }
    dynamics::number_model(model);
    dynamics::AdaptivityOptions adaptivity;
    adaptivity.full = &model;
    adaptivity.active.assign(static_cast<std::size_t>(model.num_coordinates), false);
    std::fill_n(adaptivity.active.begin(), 3, true);
    adaptivity.points = ends;
    dynamics::TransientOptions options;
    options.end_time = 0.4;
    options.adaptivity = adaptivity;
    std::vector<std::string> joined;
    options.on_event = [&](const dynamics::Event& event) {
      if (event.kind == "modes" && event.text.starts_with("joins")) joined.push_back(event.object);
    };
    Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates);
    q.head<2>() << 0.4, 0.1;
    dynamics::run_transient(model, test::make_state(model, q, Eigen::VectorXd::Zero(model.num_coordinates)), options);

    CHECK(joined.size() >= 2);
    const auto shape = [&](int end, int mode) {
      return model.markers[static_cast<std::size_t>(ends[static_cast<std::size_t>(end)])].Phi(1, mode);
    };
    for (int k = 0; k < kNumModes; ++k) {
      if (std::find(joined.begin(), joined.end(), "chassis.mode " + std::to_string(k + 1)) == joined.end()) continue;
      const double alike = shape(0, k) + sign * shape(1, k), against = shape(0, k) - sign * shape(1, k);
      INFO("mode " << k + 1);
      CHECK(std::abs(against) < 1e-6 * std::abs(alike));
    }
  }
}

TEST_CASE("At rest no mode joins, and none is said to be missed", "[truck]") {
  const AdaptiveRun rest = drive(12, 2, 8e-2, 0.3);  // before the bump
  for (const dynamics::Event& change : rest.changes) CHECK_FALSE(change.text.starts_with("joins"));
  CHECK(rest.statistics.mean_active_modes <= 2.0);  // idle ones may leave
  CHECK(rest.statistics.worst_neglect.share.worst() < 1e-3);
}

TEST_CASE("Modes do not chatter: none joins and leaves more often than its residence allows", "[truck]") {
  const AdaptiveRun run = drive(36, 2, 8e-2, 3.0);
  for (std::size_t i = 0; i < run.changes.size(); ++i) {
    if (!run.changes[i].text.starts_with("leaves")) continue;
    for (std::size_t j = i; j-- > 0;) {
      if (run.changes[j].object != run.changes[i].object) continue;
      if (!run.changes[j].text.starts_with("joins")) break;
      CHECK(run.changes[i].time - run.changes[j].time >= 0.05 - 1e-9);
      break;
    }
  }
}
