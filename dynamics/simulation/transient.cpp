#include "dynamics/simulation/transient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "dynamics/simulation/adaptive_stepper.h"
#include "dynamics/simulation/make_stepper.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxSwitchesInPlace = 100;  // within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;       // s

class TransientRun {
 public:
  TransientRun(const Model& model, const TransientOptions& options) : options_(options) {
    const auto on_repartition = [this](double time) {
      tell({time, "partition", "", "independent coordinates chosen anew"});
    };
    if (!options.adaptivity) {
      stepper_ = make_stepper(model, options.integrator, on_repartition);
      return;
    }
    const auto on_change = [this](double time, int coordinate, const std::string& what) {
      tell({time, "modes", options_.adaptivity->full->coordinate_name(coordinate), what});
    };
    auto adaptive = std::make_unique<AdaptiveStepper>(model, options.integrator, *options.adaptivity,
                                                      AdaptiveStepper::Listener{on_repartition, on_change});
    adaptive_ = adaptive.get();
    stepper_ = std::move(adaptive);
  }

  TransientStatistics run(const State& start) {
    start_time_ = start.time;
    stepper_->start(start);
    find_end_of_smoothness(start.time);
    stepper_->evaluate(start.time, SystemStepper::Level::kAccelerations);
    piece().update_branches(stepper_->equations().terms());
    stepper_->resume(start.time, smooth_end_);
    // Modes that join at the very start are there from the first output on.
    const bool is_settled =
        !(options_.adaptivity && options_.adaptivity->changes && start.time < options_.end_time);
    if (is_settled) write_outputs(start.time);
    if (start.time < options_.end_time) integrate();
    statistics_.stepper = stepper_->statistics();
    if (adaptive_) {
      statistics_.mode_changes = adaptive_->num_changes();
      statistics_.mean_active_modes = adaptive_->mean_active_modes();
      statistics_.worst_neglect = adaptive_->modes().worst();
    }
    return statistics_;
  }

 private:
  SmoothPiece& piece() { return stepper_->piece(); }

  void tell(const Event& event) const {
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
        start_anew(smooth_end_);
      } else if (result == Integrator::StepResult::kSwitched) {
        count_switch(time);
        start_anew(time);
      }
    }
    statistics_.completed = true;
  }

  // Functions of time are smooth from `time` to the next of their breaks: the integrator goes no further in
  // one go.
  void find_end_of_smoothness(double time) {
    smooth_end_ = std::min(options_.end_time, piece().update_next_break(time));
  }

  // Goes on with the branches that hold at the end of the last step.
  void start_anew(double time) {
    find_end_of_smoothness(time);
    stepper_->evaluate(time, SystemStepper::Level::kMotion);
    for (const BranchChange& change : piece().update_branches(stepper_->equations().terms())) {
      tell({time, "switch", change.element, change.text});
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
                        .modes = adaptive_ ? &adaptive_->modes() : nullptr});
  }

  const TransientOptions& options_;
  std::unique_ptr<SystemStepper> stepper_;
  const AdaptiveStepper* adaptive_ = nullptr;  // the stepper, where modes are watched
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
  return TransientRun(model, options).run(start);
}

}  // namespace sprung::dynamics
