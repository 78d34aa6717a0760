// A run that is resumed from a checkpoint makes the steps of the run that made it, bit by bit, whatever the
// method.
#include "dynamics/simulation/checkpoint.h"

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/forces/bushing.h"
#include "dynamics/forces/leaf_spring.h"
#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/simulation/transient.h"
#include "tests/catch.h"
#include "tests/dynamics/linear/cantilevers.h"
#include "tests/dynamics/small_models.h"
#include "tools/support/files/bytes.h"

using namespace sprung;
using dynamics::Checkpoint;
using dynamics::Model;
using dynamics::State;
using dynamics::SteppingMethod;
using dynamics::TransientOptions;
using dynamics::TransientStatistics;

namespace {

// Everything a run reports: outputs and events as bytes, the checkpoints as a file would hold them, and how
// many outputs and events came before each.
struct Record {
  std::vector<std::string> outputs, events, checkpoints;
  std::vector<std::size_t> outputs_before, events_before;
  TransientStatistics statistics;
};

TransientOptions record_run(TransientOptions options, Record& record) {
  options.on_output = [&](const dynamics::Snapshot& now) {
    support::ByteWriter bytes;
    bytes.transfer(now.time);
    for (const Eigen::VectorXd* values : {&now.q, &now.v, &now.v_dot}) bytes.transfer(*values);
    bytes.transfer(now.multipliers());
    bytes.transfer(now.energy.stored.total());
    bytes.transfer(now.energy.dissipated);
    bytes.transfer(now.energy.input);
    record.outputs.push_back(bytes.bytes());
  };
  options.on_event = [&](const dynamics::Event& event) {
    support::ByteWriter bytes;
    bytes.transfer(event.time);
    record.events.push_back(event.kind + event.object + event.text + bytes.bytes());
  };
  options.on_checkpoint = [&](const Checkpoint& checkpoint) {
    support::ByteWriter bytes;
    transfer_checkpoint(bytes, checkpoint);
    record.checkpoints.push_back(bytes.bytes());
    record.outputs_before.push_back(record.outputs.size());
    record.events_before.push_back(record.events.size());
  };
  return options;
}

template <class Item>
std::vector<Item> from(const std::vector<Item>& items, std::size_t first) {
  return {items.begin() + static_cast<std::ptrdiff_t>(first), items.end()};
}

std::string counts_of(const TransientStatistics& s) {
  support::ByteWriter bytes;
  const auto& integrator = s.stepper.integrator;
  for (const long count :
       {integrator.steps, integrator.error_test_failures, integrator.iteration_failures, integrator.restarts,
        s.stepper.evaluations, s.stepper.repartitions, s.output_evaluations, s.switches, s.mode_changes}) {
    bytes.transfer(count);
  }
  for (const double value :
       {s.stepper.velocity_violation, s.mean_active_modes, s.worst_neglect.deflection.time,
        s.worst_neglect.deflection.share, s.worst_neglect.acceleration.share,
        s.missing_acceleration.rms_share, s.missing_acceleration.peak_change}) {
    bytes.transfer(value);
  }
  return bytes.bytes();
}

// Runs once, then resumes from each of its checkpoints. @return number of checkpoints
std::size_t check_resumption(const Model& model, const State& start, const TransientOptions& options) {
  Record whole;
  whole.statistics = run_transient(model, start, record_run(options, whole));
  CHECK(whole.statistics.completed);
  for (std::size_t i = 0; i < whole.checkpoints.size(); ++i) {
    support::ByteReader bytes(whole.checkpoints[i]);
    Checkpoint checkpoint;
    transfer_checkpoint(bytes, checkpoint);
    CHECK(bytes.at_end());
    Record rest;
    rest.statistics = resume_transient(model, checkpoint, record_run(options, rest));
    INFO("checkpoint " << i << " at t = " << checkpoint.state.time);
    CHECK(rest.outputs == from(whole.outputs, whole.outputs_before[i]));
    CHECK(rest.events == from(whole.events, whole.events_before[i]));
    CHECK(rest.checkpoints == from(whole.checkpoints, i + 1));
    CHECK(counts_of(rest.statistics) == counts_of(whole.statistics));
  }
  return whole.checkpoints.size();
}

// A mass on a bushing that relaxes in two directions, and on a leaf spring: three internal states.
void add_rider(Model& model, int wheel) {
  const int rider = test::add_body(model, dynamics::make_rigid_body("rider", 80.0, 4.0));
  dynamics::Bushing::Parameters mount{.marker_a = test::add_marker(model, wheel, {0.0, 0.3}),
                                      .marker_b = test::add_marker(model, rider, {0.0, -0.1})};
  mount.directions[0] = {.spring = dynamics::PiecewisePolynomial({0.0, 4e4}),
                         .relaxing_stiffness = 2e4,
                         .relaxation_time = 0.02};
  mount.directions[1] = {
      .spring = dynamics::PiecewisePolynomial({0.0, 2e4}), .relaxing_stiffness = 3e4, .relaxation_time = 0.1};
  mount.directions[2] = {.spring = dynamics::PiecewisePolynomial({0.0, 9e3}),
                         .damper = dynamics::PiecewisePolynomial({0.0, 30.0})};
  model.forces.push_back(std::make_unique<dynamics::Bushing>("mount", mount));
  model.forces.push_back(std::make_unique<dynamics::LeafSpring>(
      "leaf", dynamics::LeafSpring::Parameters{.marker_a = test::add_marker(model, wheel, {0.1, 0.0}),
                                               .marker_b = test::add_marker(model, rider, {0.1, 0.0}),
                                               .free_length = 0.4,
                                               .friction = dynamics::PiecewisePolynomial({60.0}),
                                               .presliding_deflection = 0.003}));
}

// A mass on a tyre that falls, bounces and rolls over a bump: switches, and breaks of the road.
Model make_wheel(const dynamics::Road& road, bool has_rider = false) {
  Model model;
  model.gravity = {0.0, -9.81};
  const int wheel = test::add_body(model, dynamics::make_rigid_body("wheel", 40.0, 1.0));
  model.forces.push_back(std::make_unique<dynamics::PointContactTyre>(
      "tyre",
      dynamics::PointContactTyre::Parameters{
          .marker = test::add_marker(model, wheel, {0.0, 0.0}),
          .radius = 0.3,
          .spring = dynamics::PiecewisePolynomial(std::vector<double>{0.0, 9e4}),
          .damping = 300.0},
      dynamics::PlacedRoad{&road, 1.0, 0.0}));
  if (has_rider) add_rider(model, wheel);
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("A run is resumed from any checkpoint bit by bit, by every method") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = 0.7, .length = 0.4, .height = 0.05});
  const Model model = make_wheel(road);
  const State start = test::make_state(model, Eigen::Vector3d(0.0, 0.4, 0.0), Eigen::Vector3d(2.0, 0.0, 0.0));
  TransientOptions options;
  options.end_time = 1.0;
  options.output_step = 0.01;
  options.checkpoint_interval = 25;
  for (const SteppingMethod method : {SteppingMethod::kExponential, SteppingMethod::kAdams,
                                      SteppingMethod::kBdf, SteppingMethod::kGeneralizedAlpha}) {
    options.integrator.method = method;
    INFO(method_name(method));
    CHECK(check_resumption(model, start, options) >= 2);
  }
  options.integrator.generalized_alpha.fixed_step = 1e-3;
  CHECK(check_resumption(model, start, options) >= 10);
}

TEST_CASE("A run with internal states of force elements is resumed from any checkpoint bit by bit") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = 0.7, .length = 0.4, .height = 0.05});
  const Model model = make_wheel(road, true);
  REQUIRE(model.num_states() == 3);
  CHECK(model.coordinate_name(model.num_coordinates - 1) == "leaf.friction");
  CHECK(model.coordinate_name(model.num_coordinates - 3) == "mount.relaxation_x");
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates), v = q;
  q.head<6>() << 0.0, 0.35, 0.0, 0.0, 0.75, 0.0;
  v[0] = v[3] = 2.0;
  TransientOptions options;
  options.end_time = 0.6;
  options.output_step = 0.01;
  options.checkpoint_interval = 25;
  for (const SteppingMethod method : {SteppingMethod::kExponential, SteppingMethod::kAdams,
                                      SteppingMethod::kBdf, SteppingMethod::kGeneralizedAlpha}) {
    options.integrator.method = method;
    INFO(method_name(method));
    CHECK(check_resumption(model, test::make_state(model, q, v), options) >= 2);
  }
}

TEST_CASE("A run whose modes join and leave is resumed from any checkpoint bit by bit") {
  const bool has_mount = GENERATE(false, true);
  Model model;
  const std::vector<int> nodes = test::cantilevers::add_cantilever(model, "beam", {0.3, -0.2});
  using test::cantilevers::burst, test::cantilevers::frequency;
  test::cantilevers::push(model, nodes[5], burst(frequency(1), 1.0, 0.01, 1.0));
  test::cantilevers::push(model, nodes[2], burst(frequency(2), 6.0, 1.2, 1.8));
  if (has_mount) {  // with an internal state
    const int peg = test::add_marker(model, dynamics::kGround, {0.3, -0.2});
    dynamics::Bushing::Parameters mount{.marker_a = peg, .marker_b = nodes[5]};
    mount.directions[1] = {.relaxing_stiffness = 10.0, .relaxation_time = 0.1};
    model.forces.push_back(std::make_unique<dynamics::Bushing>("mount", mount));
  }
  dynamics::number_model(model);
  dynamics::AdaptivityOptions adaptivity;
  adaptivity.full = &model;
  adaptivity.points = {nodes[5]};
  adaptivity.active.assign(static_cast<std::size_t>(model.num_coordinates), true);
  for (int i = 0; i < model.num_coordinates; ++i) {
    const std::string name = model.coordinate_name(i);
    if (name.find(".mode ") != std::string::npos && !name.ends_with(".mode 1")) {
      adaptivity.active[static_cast<std::size_t>(i)] = false;
    }
  }
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates);
  q.head<2>() << 0.3, -0.2;
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(model.num_coordinates);
  TransientOptions options;
  options.end_time = 2.0;
  options.output_step = 0.02;
  options.checkpoint_interval = 30;
  options.adaptivity = adaptivity;
  CHECK(check_resumption(model, test::make_state(model, q, v), options) >= 2);

  // The indicator alone, of a run with the first mode.
  options.adaptivity->changes = false;
  const dynamics::HeldModes fixed = dynamics::hold_modes(model, adaptivity.active, q);
  CHECK(check_resumption(fixed.model,
                         test::make_state(fixed.model, select_active(fixed, q), select_active(fixed, v)),
                         options) >= 2);
}

TEST_CASE("A checkpoint of another model is refused") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = 0.7, .length = 0.4, .height = 0.05});
  const Model model = make_wheel(road);
  TransientOptions options;
  options.end_time = 1.0;
  CHECK_THROWS_AS(resume_transient(model, Checkpoint{}, options), support::DamagedBytes);
}
