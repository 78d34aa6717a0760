#include "dynamics/simulation/transient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "dynamics/simulation/adaptive_stepper.h"
#include "dynamics/simulation/make_stepper.h"
#include "dynamics/simulation/monitored_stepper.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxSwitchesInPlace = 100;  // within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;       // s

// The start in coordinates of the full model: modes that the run lacks are at zero.
State expand_start(const Model& model, const AdaptivityOptions& options, const State& start) {
  if (options.changes) return start;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(options.full->num_coordinates);
  State full{.time = start.time, .q = zero, .v = zero, .branches = start.branches};
  const HeldModes held = match_modes(model, *options.full);
  put_active(held, start.q, full.q);
  put_active(held, start.v, full.v);
  return full;
}

class TransientRun {
 public:
  TransientRun(const Model& model, const State& start, const TransientOptions& options) : options_(options) {
    const auto on_repartition = [this](double time) {
      report_event({time, "partition", "", "independent coordinates chosen anew"});
    };
    if (options.adaptivity) {
      monitor_.emplace(*options.adaptivity, expand_start(model, *options.adaptivity, start));
    }
    if (!monitor_ || !options.adaptivity->changes) {
      stepper_ = make_stepper(model, options.integrator, on_repartition);
      if (monitor_) stepper_ = std::make_unique<MonitoredStepper>(std::move(stepper_), model, *monitor_);
    } else {
      const auto on_change = [this](double time, int coordinate, const std::string& what) {
        report_event({time, "modes", options_.adaptivity->full->coordinate_name(coordinate), what});
      };
      auto adaptive = std::make_unique<AdaptiveStepper>(options.integrator, *monitor_,
                                                        AdaptiveStepper::Listener{on_repartition, on_change});
      adaptive_ = adaptive.get();
      stepper_ = std::move(adaptive);
    }
    stepper_->start(start);
    start_time_ = start.time;
  }

  TransientStatistics run() {
    find_end_of_smoothness(start_time_);
    stepper_->evaluate(start_time_, SystemStepper::Level::kAccelerations);
    piece().update_branches(stepper_->equations().terms());
    stepper_->resume(start_time_, smooth_end_);
    // Modes that join at the very start are there from the first output on.
    const bool is_settled = !(adaptive_ && start_time_ < options_.end_time);
    if (is_settled) write_outputs(start_time_);
    if (start_time_ < options_.end_time) integrate();
    statistics_.stepper = stepper_->statistics();
    if (monitor_) {
      statistics_.mean_active_modes = monitor_->modes().num_active_modes();
      statistics_.worst_neglect = monitor_->find_worst();
    }
    if (adaptive_) {
      statistics_.mode_changes = adaptive_->num_changes();
      statistics_.mean_active_modes = adaptive_->mean_active_modes();
    }
    return statistics_;
  }

 private:
  SmoothPiece& piece() { return stepper_->piece(); }

  void report_event(const Event& event) const {
    if (options_.on_event) options_.on_event(event);
  }

  void integrate() {
    while (true) {
      const double longest = std::min(options_.largest_step, stepper_->calc_longest_step());
      const Integrator::StepResult result = stepper_->step(longest);
      const double time = stepper_->time();
      write_outputs(time);
      if (options_.on_step && !options_.on_step(time)) return;
      if (result == Integrator::StepResult::kEnded) {
        if (smooth_end_ >= options_.end_time) break;
        continue_from(smooth_end_);
      } else if (result == Integrator::StepResult::kSwitched) {
        count_switch(time);
        continue_from(time);
      }
    }
    statistics_.completed = true;
  }

  // Functions of time are smooth from `time` to the next of their breaks, where the integrator has to stop.
  void find_end_of_smoothness(double time) {
    smooth_end_ = std::min(options_.end_time, piece().update_next_break(time));
  }

  // Continues with the branches that hold at the end of the last step.
  void continue_from(double time) {
    find_end_of_smoothness(time);
    stepper_->evaluate(time, SystemStepper::Level::kMotion);
    for (const BranchChange& change : piece().update_branches(stepper_->equations().terms())) {
      report_event({time, "switch", change.element, change.text});
    }
    stepper_->resume(time, smooth_end_);
  }

  void count_switch(double time) {
    num_in_place_ = time - last_switch_ > kSamePlace ? 0 : num_in_place_ + 1;
    if (num_in_place_ > kMaxSwitchesInPlace) {
      throw support::NumericalError(fmt::format(
          "a force switches back and forth without end at t = {:.9g} s; look at tyres and road there", time));
    }
    last_switch_ = time;
    ++statistics_.switches;
  }

  // Writes every output time up to `time`, which the stepper has reached; the last one exactly at the end.
  void write_outputs(double time) {
    const double tolerance = 1e-9 * options_.output_step;
    while (true) {
      const double next = start_time_ + static_cast<double>(next_output_) * options_.output_step;
      if (next > options_.end_time + tolerance || next > time + tolerance) return;
      write_output(std::min(next, time));
      ++next_output_;
    }
  }

  void write_output(double time) {
    ++statistics_.output_evaluations;
    stepper_->evaluate(time, SystemStepper::Level::kAllMarkers);
    if (!options_.on_output) return;
    const SystemStepper::Observation now = stepper_->observation();
    const SystemStepper::EnergyFlow flow = stepper_->energy_flow();
    Energy stored = calc_energy(now.equations.terms(), piece().branches());
    stored.strain += now.held_strain;
    options_.on_output({.time = time,
                        .equations = now.equations,
                        .q = now.q,
                        .v = now.v,
                        .v_dot = now.v_dot,
                        .branches = piece().branches(),
                        .energy = {stored, flow.dissipated, flow.input},
                        .modes = monitor_ ? &monitor_->modes() : nullptr});
  }

  const TransientOptions& options_;
  std::optional<ModeMonitor> monitor_;  // of modes left out, if asked for
  std::unique_ptr<SystemStepper> stepper_;
  const AdaptiveStepper* adaptive_ = nullptr;  // the stepper, where modes change
  TransientStatistics statistics_;
  double start_time_ = 0.0;
  double smooth_end_ = 0.0;  // the next break of a function of time, or the end
  double last_switch_ = -std::numeric_limits<double>::infinity();
  int num_in_place_ = 0;
  long next_output_ = 0;
};

}  // namespace

Eigen::Vector2d Snapshot::calc_acceleration(std::size_t marker) const {
  const Model& model = terms().model();
  const int b = model.markers[marker].body;
  if (b == kGround) return Eigen::Vector2d::Zero();
  const Body& body = model.bodies[static_cast<std::size_t>(b)];
  return calc_marker_acceleration(terms().markers()[marker],
                                  equations.v_dot().segment(body.first_coordinate, body.num_coordinates()));
}

TransientStatistics run_transient(const Model& model, const State& start, const TransientOptions& options) {
  return TransientRun(model, start, options).run();
}

}  // namespace sprung::dynamics
