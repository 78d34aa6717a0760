#include "dynamics/preparation/start_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/linear/assembly.h"
#include "dynamics/linear/joint_rates.h"
#include "dynamics/output/last_state.h"
#include "dynamics/system/system_terms.h"
#include "tools/support/errors/input_error.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

// The last state of an earlier run, at its time.
State find_continued_start(const PreparedRun& prepared) {
  const Run& run = prepared.run;
  State start = read_last_state(run.continue_from, prepared.model);
  const auto expect_after_start = [&](const char* what, double time) {
    if (time > start.time + 1e-9 * run.duration) return;
    throw support::InputError(run.continue_location,
                              fmt::format("{} ends at {:.9g} s, {} must be later, got {:.9g} s",
                                          run.continue_from.string(), start.time, what, time));
  };
  expect_after_start("'duration'", run.duration);
  expect_after_start("'statistics.to'", run.statistics_to);
  return start;
}

std::vector<JointRate> find_joint_rates(const Run& run, const Model& model) {
  std::vector<JointRate> rates;
  for (const JointRateRequest& request : run.joint_rates) {
    std::vector<std::string> names;
    JointRate rate{.joint = -1, .rate = request.rate, .location = request.location};
    for (std::size_t j = 0; j < model.joints.size(); ++j) {
      if (model.joints[j]->is_motion()) continue;
      names.push_back(model.joints[j]->name);
      if (names.back() == request.joint) rate.joint = static_cast<int>(j);
    }
    if (rate.joint < 0) {
      throw support::InputError(
          request.location, fmt::format("'joint_rates.{}' is about no joint of the vehicle{}", request.joint,
                                        support::nearest_name_hint(request.joint, names)));
    }
    const Joint& joint = *model.joints[static_cast<std::size_t>(rate.joint)];
    if (!joint.coordinate()) {
      throw support::InputError(request.location,
                                fmt::format("'joint_rates.{}' is about a {} joint, which has no coordinate",
                                            request.joint, joint.kind()));
    }
    rates.push_back(std::move(rate));
  }
  return rates;
}

// A vehicle with a speed moves as rigid bodies do; velocities of [initial] are those of a hit.
ModalRates find_modal_rates(const Run& run) {
  return run.initial.empty() ? ModalRates::kIfNecessary : ModalRates::kByMass;
}

// Velocities at the start, of the run's model or of one with more modes. @param[out] v  model.num_coordinates
VelocityReport find_start_velocities(const PreparedRun& prepared, const Model& model,
                                     const Eigen::VectorXd& q, Eigen::VectorXd& v) {
  const Run& run = prepared.run;
  v = make_start_velocities(run, prepared.vehicle, model);
  // The steady motion replaces the speed.
  if (prepared.equilibrium && !prepared.equilibrium->motion.is_rest()) {
    for (const Body& body : model.bodies) v[body.first_coordinate] -= prepared.vehicle.direction * run.speed;
    v += prepared.equilibrium->motion.calc_velocity(model, q);
  }
  VelocityReport report = project_velocities(model, 0.0, q, v, find_modal_rates(run));
  impose_joint_rates(model, q, find_joint_rates(run, model), v);
  return report;
}

constexpr double kSameSpeed = 1e-6;

}  // namespace

State make_state(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  return {.time = 0.0,
          .q = q,
          .v = v,
          .branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))};
}

void take_continued_speed(Run& run) {
  if (run.continue_from.empty()) return;
  const double speed = read_run_speed(run.continue_from);
  if (run.has_speed && std::abs(run.speed - speed) > kSameSpeed * std::abs(speed)) {
    throw support::InputError(
        run.speed_location,
        fmt::format(
            "'speed' must be left out, or {:.9g} m/s as in the run that this one continues, got {:.9g}: "
            "the run goes on with the velocities at the end of {}",
            speed, run.speed, run.continue_from.string()));
  }
  run.speed = speed;
}

State find_start_state(Eigen::VectorXd q, PreparedRun& prepared) {
  const Run& run = prepared.run;
  const Model& model = prepared.model;
  if (!run.continue_from.empty()) return find_continued_start(prepared);
  if (!run.initial.empty()) {
    add_initial_amplitudes(run, model, q);
    assemble_positions(model, q);
  }
  Eigen::VectorXd v;
  prepared.initial_velocities = find_start_velocities(prepared, model, q, v);
  return make_state(model, q, v);
}

MissingStart find_missing_start(const PreparedRun& prepared, const Model& full) {
  const Run& run = prepared.run;
  if (!run.continue_from.empty()) return {};
  MissingStart start{.is_balanced = prepared.equilibrium && prepared.start.q == prepared.equilibrium->q};
  const bool has_modal_rates = std::any_of(run.initial.begin(), run.initial.end(), [](const auto& body) {
    return !body.second.modal_amplitude.empty() || !body.second.modal_rate.empty();
  });
  if (has_modal_rates) return start;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(full.num_coordinates);
  put_active(match_modes(prepared.model, full), prepared.start.q, q);
  try {
    find_start_velocities(prepared, full, q, start.rates);
  } catch (const support::NumericalError&) {
    start.rates.resize(0);  // a singular position: those of the run
  }
  return start;
}

std::vector<WheelSpeed> find_wheels_of_other_speed(const PreparedRun& prepared) {
  const Model& model = prepared.model;
  Eigen::VectorXd v = make_start_velocities(prepared.run, prepared.vehicle, model);
  project_velocities(model, prepared.start.time, prepared.start.q, v, find_modal_rates(prepared.run));
  SystemTerms terms(model);
  terms.update_positions(prepared.start.time, prepared.start.q);
  terms.update_velocities(v);
  const std::vector<int> branches = terms.find_branches();
  std::vector<WheelSpeed> wheels;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    if (!force.find_road_place(terms.instant_of(f), model.branches_of(f, branches))) continue;
    const auto marker = static_cast<std::size_t>(force.markers().front());
    const double speed = prepared.vehicle.direction * terms.markers()[marker].v.x();
    if (std::abs(speed - prepared.run.speed) > kSameSpeed * std::max(prepared.run.speed, std::abs(speed)))
      wheels.push_back({force.name, speed});
  }
  return wheels;
}

}  // namespace sprung::dynamics
