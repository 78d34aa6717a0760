// The step loop: outputs, events, stopping, and switches located in a motion whose instants are known.
#include "dynamics/simulation/transient.h"

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using dynamics::PiecewisePolynomial;
using dynamics::SteppingMethod;
using Eigen::VectorXd;

namespace {

constexpr double kGravity = 9.81, kMass = 40.0, kStiffness = 9e4, kRadius = 0.3;

// A wheel alone: a mass on a linear tyre.
Model make_wheel(const dynamics::Road& road, double damping) {
  Model model;
  model.gravity = {0.0, -kGravity};
  const int wheel = test::add_body(model, dynamics::make_rigid_body("wheel", kMass, 1.0));
  model.forces.push_back(std::make_unique<dynamics::PointContactTyre>(
      "tyre",
      dynamics::PointContactTyre::Parameters{
          .marker = test::add_marker(model, wheel, {0.0, 0.0}),
          .radius = kRadius,
          .spring = PiecewisePolynomial(std::vector<double>{0.0, kStiffness}),
          .damping = damping},
      dynamics::PlacedRoad{&road, 1.0, 0.0}));
  dynamics::number_model(model);
  return model;
}

dynamics::State drop(const Model& model, double height, double speed) {
  return test::make_state(model, Eigen::Vector3d(0.0, kRadius + height, 0.0),
                          Eigen::Vector3d(speed, 0.0, 0.0));
}

}  // namespace

TEST_CASE("Outputs come at 0, at every step and at the end", "[analysis]") {
  const dynamics::FlatRoad road;
  const Model model = make_wheel(road, 0.0);
  std::vector<double> times;
  dynamics::TransientOptions options;
  options.end_time = 0.5;
  options.output_step = 0.01;
  options.on_output = [&](const dynamics::Snapshot& snapshot) { times.push_back(snapshot.time); };
  const dynamics::TransientStatistics statistics =
      dynamics::run_transient(model, drop(model, 1.0, 2.0), options);
  REQUIRE(times.size() == 51);
  for (std::size_t i = 0; i < times.size(); ++i)
    CHECK(times[i] == Approx(0.01 * static_cast<double>(i)).margin(1e-15));
  CHECK(times.back() <= 0.5);
  CHECK(statistics.completed);
  CHECK(statistics.output_evaluations == 51);
  CHECK(statistics.stepper.evaluations > 0);
}

TEST_CASE("A run can be stopped after any step", "[analysis]") {
  const dynamics::FlatRoad road;
  const Model model = make_wheel(road, 0.0);
  double stopped_at = 0.0;
  dynamics::TransientOptions options;
  options.end_time = 50.0;
  options.largest_step = 0.01;
  options.on_step = [&](double time) {
    stopped_at = time;
    return time < 0.2;
  };
  const dynamics::TransientStatistics statistics =
      dynamics::run_transient(model, drop(model, 100.0, 0.0), options);
  CHECK_FALSE(statistics.completed);
  CHECK(stopped_at >= 0.2);
  CHECK(stopped_at < 0.22);
}

TEST_CASE("A wheel dropped on the ground touches and leaves it at the instants that mechanics gives",
          "[analysis]") {
  const dynamics::FlatRoad road;
  const Model model = make_wheel(road, 0.0);
  const double height = 0.5;
  // Fall √(2h/g); then x = g/ω² + …: contact lasts (2π − 2 atan(v ω/g))/ω for ω² = k/m, v = √(2gh)
  const double fall = std::sqrt(2.0 * height / kGravity), speed = std::sqrt(2.0 * kGravity * height);
  const double omega = std::sqrt(kStiffness / kMass);
  const double contact = (2.0 * std::numbers::pi - 2.0 * std::atan(speed * omega / kGravity)) / omega;
  const std::vector<double> expected{fall, fall + contact, 3.0 * fall + contact, 3.0 * fall + 2.0 * contact};
  // The error of generalized-α goes with the tolerance to the power ⅔.
  for (const auto& [method, margin] :
       {std::pair{SteppingMethod::kExponential, 1e-8}, std::pair{SteppingMethod::kGeneralizedAlpha, 1e-6}}) {
    std::vector<dynamics::Event> events;
    double highest = 0.0;
    dynamics::TransientOptions options;
    options.end_time = expected.back() + fall;  // at the top of the second bounce
    options.integrator = {.method = method, .relative_tolerance = 1e-10};
    options.on_event = [&](const dynamics::Event& event) { events.push_back(event); };
    options.on_output = [&](const dynamics::Snapshot& snapshot) { highest = snapshot.q[1] - kRadius; };
    options.output_step = options.end_time;
    dynamics::run_transient(model, drop(model, height, 3.0), options);
    REQUIRE(events.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(events[i].time == Approx(expected[i]).margin(margin));
      CHECK(events[i].kind == "switch");
      CHECK(events[i].object == "tyre");
      CHECK(events[i].text == (i % 2 == 0 ? "touches the ground" : "leaves the ground"));
    }
    CHECK(highest == Approx(height).margin(10.0 * margin));  // nothing was lost
  }
}

TEST_CASE("A damped wheel's energy book closes through bounces and over a bump", "[analysis]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kTriangle, .start = 1.0, .length = 0.8, .height = 0.1});
  const Model model = make_wheel(road, 800.0);
  double first = 0.0, largest_error = 0.0, last_dissipated = 0.0, last_input = 0.0, least_growth = 0.0;
  dynamics::TransientOptions options;
  options.end_time = 2.0;
  options.on_output = [&](const dynamics::Snapshot& snapshot) {
    const dynamics::EnergyBook& book = snapshot.energy;
    if (snapshot.time == 0.0) first = book.stored.total();
    least_growth = std::min(least_growth, book.dissipated - last_dissipated);
    last_dissipated = book.dissipated;
    last_input = book.input;
    largest_error =
        std::max(largest_error, std::abs(book.stored.total() - first + book.dissipated - book.input));
  };
  const dynamics::TransientStatistics statistics =
      dynamics::run_transient(model, drop(model, 0.2, 3.0), options);
  CHECK(statistics.switches > 6);
  CHECK(last_dissipated > 10.0);
  CHECK(std::abs(last_input) > 1.0);
  CHECK(least_growth > -1e-4);  // J: the damper never gives energy back, to the tolerance
  CHECK(largest_error < 1e-3);  // J, of some 100 J that pass
}

TEST_CASE("A step never passes over a bump, at any tolerance", "[analysis]") {
  // At rest on smooth ground the step would grow without bound: a low, short bump 60 m ahead has to be met.
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHaversine, .start = 60.0, .length = 0.3, .height = 0.05});
  const Model model = make_wheel(road, 800.0);
  double highest = 0.0;
  dynamics::TransientOptions options;
  options.end_time = 10.0;
  options.integrator.relative_tolerance = 1e-2;
  options.on_output = [&](const dynamics::Snapshot& snapshot) {
    if (snapshot.time > 5.0) highest = std::max(highest, snapshot.q[1]);
  };
  dynamics::run_transient(model, drop(model, -kMass * kGravity / kStiffness, 10.0), options);
  CHECK(highest > kRadius + 0.03);
}
