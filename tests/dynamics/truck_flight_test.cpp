// The flexible truck in the air: conserved quantities of any vehicle.
#include <Eigen/Core>
#include <cmath>

#include "dynamics/bodies/body_equations.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/momentum.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/truck.h"

using namespace sprung;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

struct Totals {
  Vector2d momentum = Vector2d::Zero();
  double angular_momentum = 0.0;  // about the world's origin
  Vector2d center = Vector2d::Zero();
  double mass = 0.0;
};

Totals sum_up(const dynamics::Model& model, const VectorXd& q, const VectorXd& v) {
  Totals totals;
  for (const dynamics::Body& body : model.bodies) {
    const Index first = body.first_coordinate, size = body.num_coordinates();
    const test::Momentum momentum = test::calc_momentum(body, q.segment(first, size), v.segment(first, size));
    totals.momentum += momentum.linear;
    totals.angular_momentum += momentum.angular;
    totals.mass += body.mass;
    const Vector2d moment = dynamics::calc_first_moment(body, q.segment(first + 3, body.num_modes()));
    const double c = std::cos(q[first + 2]), s = std::sin(q[first + 2]);
    totals.center += body.mass * q.segment<2>(first) +
                     Vector2d(c * moment.x() - s * moment.y(), s * moment.x() + c * moment.y());
  }
  totals.center /= totals.mass;
  return totals;
}

// Thrown high above the road, spinning and vibrating.
dynamics::State throw_truck(const dynamics::Model& model, const dynamics::Vehicle& vehicle) {
  dynamics::State state{.time = 0.0,
                        .q = test::assemble_truck(model, vehicle),
                        .v = VectorXd::Zero(model.num_coordinates),
                        .branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))};
  const Vector2d pole = state.q.segment<2>(model.bodies[2].first_coordinate);
  test::RandomNumbers random(7);
  for (const dynamics::Body& body : model.bodies) {
    const Index first = body.first_coordinate;
    const Vector2d arm = state.q.segment<2>(first) - pole;
    constexpr double kSpin = 0.7;  // rad/s
    state.v.segment<3>(first) << 2.0 - kSpin * arm.y(), 3.0 + kSpin * arm.x(), kSpin;
    state.q[first + 1] += 100.0;
    for (Index k = 0; k < body.num_modes(); ++k) {
      state.v[first + 3 + k] = random.size_up_to(0.5 / body.mode_scale[k]);  // up to 0.5 m/s at some node
    }
  }
  dynamics::project_velocities(model, 0.0, state.q, state.v);
  return state;
}

const std::vector<std::string> kNoDampers{"forces.front_suspension.damper={coefficient=0.0}",
                                          "forces.rear_suspension.damper={coefficient=0.0}"};

}  // namespace

TEST_CASE("Without gravity and dampers the thrown truck keeps momentum, angular momentum and energy",
          "[truck]") {
  std::vector<std::string> changes = kNoDampers;
  changes.emplace_back("gravity=[0.0, 0.0]");
  const dynamics::Vehicle vehicle = test::read_truck(changes);
  const dynamics::FlatRoad road;
  for (const int num_modes : {2, 4}) {
    const dynamics::Model model =
        test::make_truck(vehicle, num_modes, {&road, -1.0, 0.0}, {{"chassis", {0.0}}});
    const dynamics::State start = throw_truck(model, vehicle);
    const Totals first = sum_up(model, start.q, start.v);
    // The angular momentum about the centre of mass is what the spin has; about the origin it holds the
    // flight too.
    double energy = 0.0, momentum_change = 0.0, angular_change = 0.0, energy_change = 0.0, modal_energy = 0.0;
    dynamics::TransientOptions options;
    options.end_time = 2.0;
    options.output_step = 0.01;
    options.integrator.relative_tolerance = 1e-10;
    options.on_output = [&](const dynamics::Snapshot& snapshot) {
      const Totals now = sum_up(model, snapshot.q, snapshot.v);
      const double total = snapshot.energy.stored.total();
      if (snapshot.time == 0.0) energy = total;
      momentum_change = std::max(momentum_change, (now.momentum - first.momentum).norm());
      angular_change = std::max(angular_change, std::abs(now.angular_momentum - first.angular_momentum));
      energy_change = std::max(energy_change, std::abs(total - energy));
      modal_energy = std::max(modal_energy, snapshot.energy.stored.strain);
    };
    dynamics::run_transient(model, start, options);
    INFO(num_modes << " chassis modes");
    CHECK(momentum_change < 1e-8 * first.momentum.norm());
    CHECK(angular_change < 1e-8 * std::abs(first.angular_momentum));
    CHECK(energy_change < 1e-8 * energy);
    CHECK(modal_energy > 10.0);  // it does vibrate
  }
}

TEST_CASE("In free flight the truck's centre of mass follows the parabola", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck();
  const dynamics::FlatRoad road;
  const dynamics::Model model = test::make_truck(vehicle, 2, {&road, -1.0, 0.0});
  const dynamics::State start = throw_truck(model, vehicle);
  const Totals first = sum_up(model, start.q, start.v);
  double error = 0.0;
  dynamics::TransientOptions options;
  options.end_time = 2.0;
  options.output_step = 0.05;
  options.on_output = [&](const dynamics::Snapshot& snapshot) {
    const double t = snapshot.time;
    const Vector2d expected =
        first.center + first.momentum / first.mass * t + 0.5 * t * t * Vector2d(0.0, -9.80665);
    const Totals now = sum_up(model, snapshot.q, snapshot.v);
    error = std::max(error, (now.center - expected).norm());
  };
  dynamics::run_transient(model, start, options);
  CHECK(error < 1e-6);  // m, after a flight of more than 20 m at the default relative tolerance of 1e-6
}
