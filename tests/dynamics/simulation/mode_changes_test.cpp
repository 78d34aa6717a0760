// Modes that join and leave on the truck: the shares left out, and the results.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/forces/applied_force.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/simulation/transient.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"
#include "tests/dynamics/truck.h"

using namespace sprung;

namespace {

struct AdaptiveRun {
  Eigen::VectorXd origin,
      deflection;  // vertical acceleration of the middle, of the front end's deflection [m/s², m]
  std::vector<dynamics::Event> changes;
  dynamics::TransientStatistics statistics;
  double closure = 0.0;
};

// The bump with all modes of the chassis at hand; num_start of them at the start, none joining where recall
// is 0.
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
    adaptivity.points = {bump.model.find_marker("chassis.origin"),
                         bump.model.find_marker("chassis.front_end")};
    adaptivity.thresholds.recall = recall;
    adaptivity.thresholds.drop = std::min(2e-3, 0.2 * recall);
    options.adaptivity = adaptivity;
  }
  std::vector<double> origin, deflection;
  test::EnergyClosure closure;
  const auto front = static_cast<std::size_t>(bump.model.find_marker("chassis.front_end"));
  options.on_output = [&](const dynamics::Snapshot& now) {
    origin.push_back(now.v_dot[body.first_coordinate + 1]);
    const Eigen::Vector2d u = bump.model.markers[front].Phi.topRows<2>() *
                              now.q.segment(body.first_coordinate + 3, body.num_modes());
    deflection.push_back(u.y());
    closure.add(now.energy);
  };
  options.on_event = [&](const dynamics::Event& event) {
    if (event.kind == "modes") run.changes.push_back(event);
  };
  run.statistics = dynamics::run_transient(bump.model, bump.state, options);
  run.origin = Eigen::Map<Eigen::VectorXd>(origin.data(), static_cast<Eigen::Index>(origin.size()));
  run.deflection =
      Eigen::Map<Eigen::VectorXd>(deflection.data(), static_cast<Eigen::Index>(deflection.size()));
  run.closure = closure.value();
  return run;
}

double peak(const Eigen::VectorXd& x) {
  return x.cwiseAbs().maxCoeff();
}

}  // namespace

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
  // Steps with a larger share left out were repeated.
  CHECK(adaptive.statistics.worst_neglect.share() > 0.0);
  CHECK(adaptive.statistics.worst_neglect.share() <= 8e-2 * (1.0 + 1e-9));

  SECTION("and its error decreases with a smaller threshold") {
    const AdaptiveRun closer = drive(36, 2, 1e-2, duration);
    const double scale = peak(full.deflection);
    CHECK((closer.deflection - full.deflection).cwiseAbs().maxCoeff() < 0.01 * scale);
    CHECK((closer.deflection - full.deflection).norm() < (adaptive.deflection - full.deflection).norm());
    CHECK((closer.origin - full.origin).norm() < 0.5 * (adaptive.origin - full.origin).norm());
    CHECK(closer.statistics.worst_neglect.share() <= 1e-2 * (1.0 + 1e-9));
  }
  SECTION("the share of modes left out is reported as of its time, not with the modes active at the end") {
    const AdaptiveRun whole = drive(36, 2, 2e-2, 5.0);
    CHECK(whole.statistics.worst_neglect.share() <= 2e-2 * (1.0 + 1e-9));
  }
  SECTION("the result is the same each time") {
    const AdaptiveRun again = drive(36, 2, 8e-2, duration);
    CHECK(again.origin == adaptive.origin);
    CHECK(again.changes.size() == adaptive.changes.size());
  }
}

TEST_CASE("Of a pair of equal frequency only the member that the load excites joins", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck();
  const auto chassis =
      std::find_if(vehicle.bodies.begin(), vehicle.bodies.end(),
                   [](const dynamics::BodyDescription& body) { return body.name == "chassis"; });
  const reduce::Superelement& superelement = *vehicle.superelement_of(*chassis);
  constexpr int kNumModes = 12;
  std::vector<int> modes(kNumModes);
  for (int k = 0; k < kNumModes; ++k) modes[static_cast<std::size_t>(k)] = k + 1;
  REQUIRE(superelement.cluster[0] == superelement.cluster[1]);

  // The chassis alone, held at its middle where the modes are clamped, both ends pushed: alike, then against
  // each other.
  for (const double sign : {1.0, -1.0}) {
    dynamics::Model model;
    const int body = test::add_body(model, dynamics::make_flexible_body("chassis", superelement, modes));
    const int ground = test::add_marker(model, dynamics::kGround, {0.4, 0.1});
    model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
        "root", ground, test::add_marker(model, body, {0.0, 0.0}), support::SourceLocation{},
        dynamics::make_fixed_joint(0.0)));
    std::vector<int> ends;
    for (const double towards : {-1.0, 1.0}) {
      int end = 0;
      for (int node = 0; node < superelement.num_nodes(); ++node) {
        if (towards * (superelement.node_positions(0, node) - superelement.node_positions(0, end)) > 0.0)
          end = node;
      }
      ends.push_back(test::add_node_marker(model, body, superelement, end));
      const double size = towards < 0.0 ? 1e4 : sign * 1e4;
      model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
          "push",
          dynamics::AppliedForce::Parameters{.marker = ends.back(),
                                             .axes = dynamics::AppliedForce::Axes::kWorld,
                                             .force_x = dynamics::TimeFunction(0.0),
                                             .force_y = dynamics::TimeFunction::smooth_step(
                                                 {.before = 0.0, .after = size, .start = 0.05, .end = 0.06}),
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
    dynamics::run_transient(model, test::make_state(model, q, Eigen::VectorXd::Zero(model.num_coordinates)),
                            options);

    CHECK(joined.size() >= 2);
    const auto shape = [&](int end, int mode) {
      return model.markers[static_cast<std::size_t>(ends[static_cast<std::size_t>(end)])].Phi(1, mode);
    };
    for (int k = 0; k < kNumModes; ++k) {
      if (std::find(joined.begin(), joined.end(), "chassis.mode " + std::to_string(k + 1)) == joined.end())
        continue;
      const double alike = shape(0, k) + sign * shape(1, k), against = shape(0, k) - sign * shape(1, k);
      INFO("mode " << k + 1);
      CHECK(std::abs(against) < 1e-6 * std::abs(alike));
    }
  }
}

TEST_CASE("At rest no mode joins, and none is reported as left out", "[truck]") {
  const AdaptiveRun rest = drive(12, 2, 8e-2, 0.3);  // before the bump
  for (const dynamics::Event& change : rest.changes) CHECK_FALSE(change.text.starts_with("joins"));
  CHECK(rest.statistics.mean_active_modes <= 2.0);  // idle ones may leave
  CHECK(rest.statistics.worst_neglect.share() < 1e-3);
}

TEST_CASE("No mode joins and leaves more often than its residence allows", "[truck]") {
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
