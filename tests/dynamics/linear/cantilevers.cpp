#include "tests/dynamics/linear/cantilevers.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "dynamics/forces/applied_force.h"
#include "dynamics/joints/coordinate_joint.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

namespace sprung::test::cantilevers {

using dynamics::Model;
using dynamics::TimeFunction;

BeamSuperelement make_cantilever() {
  return make_beam_superelement(
      make_straight_beam("cantilever", {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}, 1e8, 800.0, 10.0), kNumModes);
}

std::vector<int> add_cantilever(Model& model, const std::string& name, const Eigen::Vector2d& root) {
  const reduce::Superelement superelement = make_cantilever().superelement;
  std::vector<int> modes(kNumModes);
  for (int k = 0; k < kNumModes; ++k) modes[static_cast<std::size_t>(k)] = k + 1;
  const int body = add_body(model, dynamics::make_flexible_body(name, superelement, modes));
  std::vector<int> nodes;
  for (int node = 0; node < 6; ++node) nodes.push_back(add_node_marker(model, body, superelement, node));
  const int ground = add_marker(model, dynamics::kGround, root);
  model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
      name + " root", ground, nodes[0], support::SourceLocation{}, dynamics::make_fixed_joint(0.0)));
  return nodes;
}

void push(Model& model, int marker, TimeFunction force) {
  model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
      "push", dynamics::AppliedForce::Parameters{.marker = marker,
                                                 .axes = dynamics::AppliedForce::Axes::kWorld,
                                                 .force_x = TimeFunction(0.0),
                                                 .force_y = std::move(force),
                                                 .torque = TimeFunction(0.0)}));
}

double frequency(int mode) {  // [Hz], from 1
  return make_cantilever().superelement.frequency_hz[mode - 1];
}

TimeFunction burst(double frequency_hz, double amplitude, double start, double end) {
  std::vector<double> t{0.0}, x{0.0};
  const int count = static_cast<int>(40.0 * frequency_hz * (end - start));
  for (int i = 0; i <= count; ++i) {
    const double s = static_cast<double>(i) / count, time = start + s * (end - start);
    t.push_back(time);
    x.push_back(amplitude * std::pow(std::sin(std::numbers::pi * s), 2) *
                std::sin(2.0 * std::numbers::pi * frequency_hz * (time - start)));
  }
  return TimeFunction::spline(t, x);
}

Run drive(const Model& model, const Case& test_case) {
  Run run;
  dynamics::AdaptivityOptions adaptivity;
  adaptivity.full = &model;
  adaptivity.changes = test_case.changes;
  adaptivity.thresholds.recall = test_case.recall;
  adaptivity.thresholds.drop = test_case.drop;
  adaptivity.points = {test_case.watched};
  int mode = 0;
  for (int i = 0; i < model.num_coordinates; ++i) {
    const bool is_modal = model.coordinate_name(i).find(".mode ") != std::string::npos;
    const auto& active = test_case.active;
    adaptivity.active.push_back(!is_modal || std::find(active.begin(), active.end(), mode) != active.end());
    if (is_modal) ++mode;
  }
  dynamics::TransientOptions options;
  options.end_time = test_case.duration;
  options.integrator.relative_tolerance = test_case.tolerance;
  options.adaptivity = adaptivity;
  options.on_output = [&](const dynamics::Snapshot& now) {
    run.tip.push_back(now.terms().markers()[static_cast<std::size_t>(test_case.watched)].r.y());
    run.tip_acceleration.push_back(now.calc_acceleration(static_cast<std::size_t>(test_case.watched)).y());
    run.energy.push_back(now.energy);
    if (now.modes) run.num_active.push_back(now.modes->num_active_modes());
  };
  options.on_event = [&](const dynamics::Event& event) {
    if (event.kind == "modes")
      run.changes.push_back({event.time, event.object, event.text.starts_with("joins"), event.text});
  };
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates);
  for (const dynamics::Body& body : model.bodies) {
    const auto& root = *std::find_if(model.joints.begin(), model.joints.end(),
                                     [&](const auto& joint) { return joint->name == body.name + " root"; });
    q.segment<2>(body.first_coordinate) = model.markers[static_cast<std::size_t>(root->marker_a)].p_BP;
  }
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(model.num_coordinates);
  if (test_case.active == kAll && !test_case.may_leave) options.adaptivity.reset();
  if (test_case.changes) {
    run.statistics = dynamics::run_transient(model, make_state(model, q, v), options);
  } else {
    const dynamics::HeldModes fixed = dynamics::hold_modes(model, adaptivity.active, q);
    run.statistics = dynamics::run_transient(
        fixed.model, make_state(fixed.model, select_active(fixed, q), select_active(fixed, v)), options);
  }
  return run;
}

double largest(const std::vector<double>& x) {
  double value = 0.0;
  for (const double one : x) value = std::max(value, std::abs(one));
  return value;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double value = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) value = std::max(value, std::abs(a[i] - b[i]));
  return value;
}

}  // namespace sprung::test::cantilevers
