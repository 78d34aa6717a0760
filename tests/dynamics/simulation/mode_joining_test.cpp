// How modes join and leave if they are coupled to others: bending modes of a beam on a pin, whose frame is at
// the pin, are coupled by its rotation.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/adaptivity/full_motion.h"
#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/adaptivity/mode_change_ringing.h"
#include "dynamics/forces/applied_force.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/simulation/transient.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using dynamics::TimeFunction;

namespace {

constexpr int kNumModes = 6;
constexpr double kSpin = 3.0;  // rad/s: what the tip's acceleration is compared with

struct Beam {
  int body = 0, tip = 0;
};

Beam add_beam(Model& model, const std::string& name, const Eigen::Vector2d& root, bool is_pinned) {
  const reduce::Superelement superelement =
      test::make_beam_superelement(
          test::make_straight_beam("beam", {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}, 1e8, 800.0, 10.0), kNumModes)
          .superelement;
  std::vector<int> modes(kNumModes);
  for (int k = 0; k < kNumModes; ++k) modes[static_cast<std::size_t>(k)] = k + 1;
  const int body = test::add_body(model, dynamics::make_flexible_body(name, superelement, modes));
  const int node = test::add_node_marker(model, body, superelement, 0);
  const int ground = test::add_marker(model, dynamics::kGround, root);
  if (is_pinned) {
    test::add_pin(model, name + " root", ground, node);
  } else {
    model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
        name + " root", ground, node, support::SourceLocation{}, dynamics::make_fixed_joint(0.0)));
  }
  return {body, test::add_node_marker(model, body, superelement, 5)};
}

void push(Model& model, int marker, double force, double start, double end) {
  model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
      "push",
      dynamics::AppliedForce::Parameters{
          .marker = marker,
          .axes = dynamics::AppliedForce::Axes::kFollowing,
          .force_x = TimeFunction(0.0),
          .force_y = TimeFunction::smooth_step({.before = 0.0, .after = force, .start = start, .end = end}),
          .torque = TimeFunction(0.0)}));
}

struct Run {
  std::vector<double> time, tip;  // acceleration of the turning beam's tip along its normal [m/s²]
  std::vector<double> joinings, leavings;
  std::vector<int> num_active;  // modes of both, at each output
};

// The beam rotates; another one, bent from the start, sets the size of a large deflection.
struct Turning {
  Model model;
  Beam beam, other;
  std::vector<bool> left_out;  // modes of the turning beam at the start
  double duration = 1.0;
  double drop = -1.0;  // none leaves, not even at rest

  explicit Turning(std::vector<bool> modes_left_out) : left_out(std::move(modes_left_out)) {
    beam = add_beam(model, "beam", {0.0, 0.0}, true);
    other = add_beam(model, "other", {0.0, 3.0}, false);
    push(model, other.tip, 0.3, 0.0, 0.05);
  }

  Run drive(bool adaptive) {
    Run run;
    dynamics::AdaptivityOptions adaptivity;
    adaptivity.full = &model;
    adaptivity.thresholds.drop = drop;
    adaptivity.points = {beam.tip};
    adaptivity.active.assign(static_cast<std::size_t>(model.num_coordinates), true);
    const int first = model.bodies[static_cast<std::size_t>(beam.body)].first_coordinate;
    for (std::size_t k = 0; k < left_out.size(); ++k)
      adaptivity.active[static_cast<std::size_t>(first) + 3 + k] = !left_out[k];
    dynamics::TransientOptions options;
    options.end_time = duration;
    options.output_step = 2e-4;
    if (adaptive) options.adaptivity = adaptivity;
    options.on_output = [&](const dynamics::Snapshot& now) {
      run.time.push_back(now.time);
      if (now.modes) run.num_active.push_back(now.modes->num_active_modes());
      const double angle = now.q[first + 2];
      const Eigen::Vector2d a = now.calc_acceleration(static_cast<std::size_t>(beam.tip));
      run.tip.push_back(-std::sin(angle) * a.x() + std::cos(angle) * a.y());
    };
    options.on_event = [&](const dynamics::Event& event) {
      if (event.kind != "modes") return;
      (event.text.starts_with("joins") ? run.joinings : run.leavings).push_back(event.time);
    };
    Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates), v = q;
    q[model.bodies[static_cast<std::size_t>(other.body)].first_coordinate + 1] = 3.0;
    v[first + 2] = kSpin;
    dynamics::run_transient(model, test::make_state(model, q, v), options);
    return run;
  }
};

double largest_difference(const Run& a, const Run& b, double since) {
  REQUIRE(a.tip.size() == b.tip.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.tip.size(); ++i) {
    if (a.time[i] > since) largest = std::max(largest, std::abs(a.tip[i] - b.tip[i]));
  }
  return largest;
}

}  // namespace

TEST_CASE("A mode below the active ones joins without ringing, alone and with others", "[adaptivity]") {
  // Because all else moves by its inertia, the first mode seems to vibrate far faster than the motion that
  // its joining adds.
  const std::vector<std::vector<int>> cases{{0}, {0, 1}, {0, 3}};
  for (const std::vector<int>& joining : cases) {
    std::vector<bool> left_out(kNumModes, false);
    for (const int mode : joining) left_out[static_cast<std::size_t>(mode)] = true;
    INFO("of " << joining.size() << " modes left out the last is " << joining.back() + 1);
    Turning turning(left_out);
    push(turning.model, turning.beam.tip, 5.0, 0.1, 0.9);
    dynamics::number_model(turning.model);
    const Run full = turning.drive(false), adaptive = turning.drive(true);
    REQUIRE(!adaptive.joinings.empty());
    CHECK(adaptive.joinings.front() > 0.2);
    // A tenth of the threshold, and the vibration that such a slow force excites by then. A release that is
    // too fast gave three to ten times as much.
    const double largest = kSpin * kSpin * 1.0;  // acceleration of the tip, 1 m from the pin
    CHECK(largest_difference(full, adaptive, 0.0) < 1.3 * 0.1 * 0.08 * largest);
  }
}

TEST_CASE("The number of active modes at an output is that of the events until then", "[adaptivity]") {
  Turning turning(std::vector<bool>(kNumModes, false));
  turning.drop = 0.02;
  push(turning.model, turning.beam.tip, 5.0, 0.1, 0.3);
  dynamics::number_model(turning.model);
  const Run run = turning.drive(true);
  const auto count = [](const std::vector<double>& times, double until) {
    return static_cast<int>(std::count_if(times.begin(), times.end(), [&](double t) { return t < until; }));
  };
  CHECK(run.leavings.size() >= 4);
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    INFO("at " << run.time[i] << " s");
    const int before =
        2 * kNumModes + count(run.joinings, run.time[i] - 1e-9) - count(run.leavings, run.time[i] - 1e-9);
    const int after =
        2 * kNumModes + count(run.joinings, run.time[i] + 1e-9) - count(run.leavings, run.time[i] + 1e-9);
    if (before == after)
      REQUIRE(run.num_active[i] == after);  // at the instant of an event both numbers are right
  }
}

TEST_CASE("A mode released 2 ms later leaves the release of another as it is", "[adaptivity]") {
  Turning turning(std::vector<bool>(kNumModes, false));
  dynamics::number_model(turning.model);
  const dynamics::Body& body = turning.model.bodies[static_cast<std::size_t>(turning.beam.body)];
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(turning.model.num_coordinates);
  dynamics::FullMotion motion(turning.model, test::make_state(turning.model, zero, zero));
  std::vector<bool> active(static_cast<std::size_t>(turning.model.num_coordinates), true);
  const int first = body.first_coordinate + 3;
  const auto fading_at = [&](double time) { return motion.state_for(motion.hold(active), time, {}).fading; };
  active[static_cast<std::size_t>(first) + 1] = active[static_cast<std::size_t>(first) + 2] = false;
  motion.release(first + 3, 7.0, 0.1, 0.01);
  REQUIRE(fading_at(0.1).size() == 1);
  CHECK(fading_at(0.1)[0].coordinate == first + 1);  // two coordinates before it are held
  active[static_cast<std::size_t>(first) + 2] = true;
  motion.release(first + 2, -3.0, 0.102, 0.004);
  const std::vector<dynamics::FadingForce> both = fading_at(0.102);
  REQUIRE(both.size() == 2);
  // F (1 + cos πs)/2 halfway, and a quarter of the way: (1 + √½)/2.
  CHECK(both[0].coordinate == first + 2);
  CHECK(both[0].value(0.105) == Approx(3.5).epsilon(1e-9));
  CHECK(both[1].coordinate == first + 1);
  CHECK(both[1].value(0.103) == Approx(-3.0 * 0.5 * (1.0 + std::sqrt(0.5))).epsilon(1e-9));
  CHECK(fading_at(0.1065).size() == 1);
}

TEST_CASE("Modes are stopped together only where the impulse leaves little ringing, as much as was predicted",
          "[adaptivity]") {
  Turning turning(std::vector<bool>(kNumModes, false));
  dynamics::number_model(turning.model);
  const Model& model = turning.model;
  const dynamics::Body& body = model.bodies[static_cast<std::size_t>(turning.beam.body)];
  const int first = body.first_coordinate, slow = first + 3, fast = first + 5;  // modes 1 and 3
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates), v = q;
  q[model.bodies[static_cast<std::size_t>(turning.other.body)].first_coordinate + 1] = 3.0;
  v[first + 2] = kSpin;

  dynamics::AdaptivityOptions options;
  options.full = &model;
  options.active.assign(static_cast<std::size_t>(model.num_coordinates), true);
  options.points = {turning.beam.tip};
  const dynamics::State start = test::make_state(model, q, v);
  dynamics::ModeAdaptation adaptation(options, start);
  dynamics::PartitionedEquations equations(model);
  equations.choose_partition_at(0.0, q);
  std::vector<double> q_i, v_i;
  for (const int i : equations.partition().independent) {
    q_i.push_back(q[i]);
    v_i.push_back(v[i]);
  }
  REQUIRE(equations.update_positions(0.0, q_i) == dynamics::PartitionedEquations::Outcome::kGood);
  equations.update_velocities(v_i);
  equations.update_accelerations(start.branches);
  adaptation.update(0.0, equations.constrained(), equations.q(), equations.v(), equations.v_dot());
  const double largest = kSpin * kSpin * 1.0;  // acceleration of the tip so far

  v[fast] = 0.01;
  const double share = calc_stopping_shares(adaptation.indicator(), {fast}, v)[0];
  // Stopped, the motion goes on without the mode: what rings at the tip is normal to the beam, the spin along
  // it.
  std::vector<bool> active = options.active;
  active[static_cast<std::size_t>(fast)] = false;
  dynamics::FullMotion motion(model, test::make_state(model, q, v));
  const dynamics::HeldModes held = motion.hold(active);
  motion.stop({fast}, held, 0.0, start.branches);
  double rings = 0.0;
  dynamics::TransientOptions run;
  run.end_time = 0.2;
  run.output_step = 1e-4;
  run.on_output = [&](const dynamics::Snapshot& now) {
    const Eigen::Vector2d a = now.calc_acceleration(static_cast<std::size_t>(turning.beam.tip));
    const double angle = now.q[first + 2];
    rings = std::max(rings, std::abs(-std::sin(angle) * a.x() + std::cos(angle) * a.y()));
  };
  dynamics::run_transient(held.model, motion.state_for(held, 0.0, start.branches), run);
  INFO("rings by " << rings / largest << ", foretold " << share);
  CHECK(rings > 0.7 * share * largest);
  CHECK(rings < 2.3 * share * largest);  // five vibrations, each at its largest at once: √5

  // The slow one is at rest; the other goes with it only where a tenth of the threshold is kept.
  const double allowed = 0.1 * options.thresholds.recall;
  v[fast] *= 1.1 * allowed / calc_stopping_shares(adaptation.indicator(), {slow, fast}, v)[1];
  CHECK(adaptation.find_stoppable({slow, fast}, v) == std::vector<int>{slow});
  v[fast] *= 0.9 / 1.1;
  CHECK(adaptation.find_stoppable({slow, fast}, v) == std::vector<int>{slow, fast});
}
