// Modes that join and leave: what is held, what is missed, what is carried over.
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "dynamics/analysis/transient.h"
#include "dynamics/system/held_modes.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
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
    adaptivity.drop = 0.2 * recall;
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

TEST_CASE("Over the bump modes join in time: the adaptive run has the full set's peaks", "[truck]") {
  const double duration = 2.0;
  const AdaptiveRun full = drive(36, 36, 0.0, duration);
  const AdaptiveRun adaptive = drive(36, 2, 1e-2, duration);
  const AdaptiveRun two = drive(2, 2, 0.0, duration);
  CHECK(peak(adaptive.origin) == Approx(peak(full.origin)).epsilon(0.02));
  CHECK(peak(adaptive.deflection) == Approx(peak(full.deflection)).epsilon(0.02));
  CHECK(peak(two.origin) < 0.6 * peak(full.origin));
  CHECK(adaptive.statistics.mean_active_modes < 24.0);
  CHECK(adaptive.closure < 1e-5);
  CHECK(adaptive.changes.size() > 20);

  SECTION("and comes closer with a smaller threshold") {
    const AdaptiveRun closer = drive(36, 2, 1e-3, duration);
    const double scale = peak(full.deflection);
    CHECK((closer.deflection - full.deflection).cwiseAbs().maxCoeff() < 0.01 * scale);
    CHECK((closer.deflection - full.deflection).norm() < (adaptive.deflection - full.deflection).norm());
    CHECK((closer.origin - full.origin).norm() < 0.5 * (adaptive.origin - full.origin).norm());
  }
  SECTION("the same each time") {
    const AdaptiveRun again = drive(36, 2, 1e-2, duration);
    CHECK(again.origin == adaptive.origin);
    CHECK(again.changes.size() == adaptive.changes.size());
  }
}

TEST_CASE("At rest no mode joins, and none is said to be missed", "[truck]") {
  const AdaptiveRun rest = drive(12, 2, 1e-2, 0.3);  // before the bump
  for (const dynamics::Event& change : rest.changes) CHECK_FALSE(change.text.starts_with("joins"));
  CHECK(rest.statistics.mean_active_modes <= 2.0);  // idle ones may leave
  CHECK(rest.statistics.worst_neglect.share.worst() < 1e-3);
}

TEST_CASE("Modes do not chatter: none joins and leaves more often than its residence allows", "[truck]") {
  const AdaptiveRun run = drive(36, 2, 1e-2, 3.0);
  for (std::size_t i = 0; i < run.changes.size(); ++i) {
    if (!run.changes[i].text.starts_with("leaves")) continue;
    for (std::size_t j = i; j-- > 0;) {
      if (run.changes[j].object != run.changes[i].object) continue;
      if (!run.changes[j].text.starts_with("joins")) break;
      CHECK(run.changes[i].time - run.changes[j].time >= 0.2 - 1e-9);
      break;
    }
  }
}
