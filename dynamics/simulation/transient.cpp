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
#include "tools/support/files/bytes.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxSwitchesInPlace = 100;  // within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;       // s
constexpr long kOutputsPerEstimate = 4;   // of errors: at each it would cost up to 4 % of the run
constexpr long kStepsPerObservation = 5;  // between outputs: with Adams, each costs half of a step

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
  TransientRun(const Model& model, const TransientOptions& options) : model_(model), options_(options) {}

  TransientStatistics run(const State& start) {
    reached_.start = reached_.state = start;
    const double time = start.time;
    start_stepper();
    piece().update_branches(stepper_->equations().terms());
    if (options_.adaptivity && options_.adaptivity->continues) pass_jump(time);
    stepper_->resume(time, smooth_end_);
    if (!may_join(time)) write_outputs(time);
    if (time < options_.end_time) integrate();
    return calc_statistics();
  }

  TransientStatistics resume(const Checkpoint& checkpoint) {
    reached_ = checkpoint;
    restart();
    integrate();
    return calc_statistics();
  }

 private:
  // Makes a stepper that knows nothing but `reached_`, and evaluates there.
  void start_stepper() {
    const auto on_repartition = [this](double time) {
      report_event({time, "partition", "", "independent coordinates chosen anew"});
    };
    stepper_.reset();
    if (options_.adaptivity) {
      monitor_.emplace(*options_.adaptivity, expand_start(model_, *options_.adaptivity, reached_.start));
      support::ByteReader bytes(reached_.monitor);
      if (!bytes.at_end()) monitor_->restore(bytes);
      if (!bytes.at_end()) throw support::DamagedBytes();
    }
    if (!monitor_ || !options_.adaptivity->changes) {
      stepper_ = make_stepper(model_, options_.integrator, on_repartition);
      if (monitor_) stepper_ = std::make_unique<MonitoredStepper>(std::move(stepper_), model_, *monitor_);
    } else {
      const auto on_change = [this](double time, int coordinate, const std::string& what) {
        report_event({time, "modes", options_.adaptivity->full->coordinate_name(coordinate), what});
      };
      auto adaptive = std::make_unique<AdaptiveStepper>(options_.integrator, *monitor_,
                                                        AdaptiveStepper::Listener{on_repartition, on_change});
      adaptive_ = adaptive.get();
      stepper_ = std::move(adaptive);
    }
    const double time = reached_.state.time;
    stepper_->start(reached_.state);
    find_end_of_smoothness(time);
    stepper_->evaluate(time, SystemStepper::Level::kAccelerations);
    if (reached_.small_motion) stepper_->continue_small_motion(*reached_.small_motion);
  }

  void restart() {
    start_stepper();
    stepper_->resume(reached_.state.time, smooth_end_);
  }

  // At the end of a step within a smooth piece. The run continues from the checkpoint as one that is resumed.
  void make_checkpoint() {
    const double time = stepper_->time();
    stepper_->evaluate(time, SystemStepper::Level::kAccelerations);
    const SystemStepper::Observation now = stepper_->observation();
    support::ByteWriter monitor;
    if (monitor_) monitor_->save(monitor);
    reached_.monitor = monitor.bytes();
    reached_.small_motion = stepper_->small_motion();
    reached_.statistics = calc_statistics();
    reached_.active_mode_time = calc_active_mode_time();
    reached_.flow = calc_energy_flow();
    reached_.state = {.time = time, .q = now.q, .v = now.v, .branches = piece().branches()};
    if (options_.on_checkpoint) options_.on_checkpoint(reached_);
    restart();
  }

  SystemStepper::EnergyFlow calc_energy_flow() const {
    const SystemStepper::EnergyFlow flow = stepper_->energy_flow();
    return {reached_.flow.dissipated + flow.dissipated, reached_.flow.input + flow.input};
  }

  double calc_active_mode_time() const {
    return reached_.active_mode_time + (adaptive_ ? adaptive_->active_mode_time() : 0.0);
  }

  TransientStatistics calc_statistics() const {
    TransientStatistics statistics = reached_.statistics;
    statistics.stepper += stepper_->statistics();
    if (monitor_) {
      statistics.mean_active_modes = monitor_->modes().num_active_modes();
      statistics.worst_neglect = monitor_->find_worst();
      statistics.missing_acceleration = monitor_->find_missing_acceleration();
    }
    if (adaptive_) {
      statistics.mode_changes += adaptive_->num_changes();
      const double length = stepper_->time() - reached_.start.time;
      if (length > 0.0) statistics.mean_active_modes = calc_active_mode_time() / length;
    }
    return statistics;
  }

  SmoothPiece& piece() { return stepper_->piece(); }

  void report_event(const Event& event) const {
    if (options_.on_event) options_.on_event(event);
  }

  void integrate() {
    while (true) {
      const double longest = std::min(options_.largest_step, stepper_->calc_longest_step());
      const Integrator::StepResult result = stepper_->step(longest);
      const double time = stepper_->time();
      const bool at_end = result == Integrator::StepResult::kEnded && smooth_end_ >= options_.end_time;
      const bool at_break = result == Integrator::StepResult::kEnded && next_break_ <= smooth_end_;
      ++work_;
      const auto first_output = reached_.next_output;
      write_outputs(at_break ? time - 2.0 * output_tolerance() : time);
      if (reached_.next_output == first_output && work_ % kStepsPerObservation == 0) observe_between();
      if (options_.on_step && !options_.on_step(time)) return;
      if (at_break) {  // a function that jumps has its later value
        last_break_ = time;
        begin_piece(smooth_end_);
        if (!at_end) stepper_->resume(time, smooth_end_);
        if (!may_join(time)) write_outputs(time);
      }
      if (at_end) break;
      if (result == Integrator::StepResult::kSwitched) {
        count_switch(time);
        begin_piece(time);
        stepper_->resume(time, smooth_end_);
      } else if (work_ >= options_.checkpoint_interval && !(adaptive_ && adaptive_->ends_at_rest())) {
        work_ = 0;
        make_checkpoint();
      }
    }
    reached_.statistics.completed = true;
  }

  // Functions of time are smooth from `time` to the next of their breaks, where the integrator has to stop.
  void find_end_of_smoothness(double time) {
    next_break_ = piece().update_next_break(time);
    smooth_end_ = std::min(options_.end_time, next_break_);
  }

  // Takes the functions of time and the branches that hold from the end of the last step on.
  void begin_piece(double time) {
    find_end_of_smoothness(time);
    stepper_->evaluate(time, SystemStepper::Level::kMotion);
    for (const BranchChange& change : piece().update_branches(stepper_->equations().terms())) {
      report_event({time, "switch", change.element, change.text});
    }
  }

  // Where functions of time jump at the start of a run that continues another, the forces before the jump are
  // those that have held the modes left out.
  void pass_jump(double time) {
    if (piece().update_next_break(time - 2.0 * kSamePlace) > time + kSamePlace) {
      find_end_of_smoothness(time);
      return;
    }
    stepper_->evaluate(time, SystemStepper::Level::kAccelerations);
    stepper_->resume(time, options_.end_time);
    begin_piece(time);
  }

  void count_switch(double time) {
    reached_.switches_in_place =
        time - reached_.last_switch > kSamePlace ? 0 : reached_.switches_in_place + 1;
    if (reached_.switches_in_place > kMaxSwitchesInPlace) {
      throw support::NumericalError(
          fmt::format("a force switches back and forth without end at t = {:.9g} s; look there at tyres on "
                      "the road, friction "
                      "and dampers with two rates",
                      time));
    }
    reached_.last_switch = time;
    ++reached_.statistics.switches;
  }

  // Whether the next step, which starts there, may show that modes join there: an output waits for them.
  bool may_join(double time) const { return adaptive_ && time < options_.end_time; }

  double output_tolerance() const { return 1e-9 * options_.output_step; }

  // Writes every output time up to `time`, which the stepper has reached; one that is meant to be there, or
  // at the last break, exactly there.
  void write_outputs(double time) {
    const double tolerance = output_tolerance();
    while (true) {
      const double next =
          reached_.start.time + static_cast<double>(reached_.next_output) * options_.output_step;
      if (next > options_.end_time + tolerance || next > time + tolerance) return;
      write_output(next < time - tolerance ? std::max(next, last_break_) : time);
      ++reached_.next_output;
    }
  }

  void write_output(double time) {
    ++reached_.statistics.output_evaluations;
    ++work_;
    stepper_->evaluate(time, SystemStepper::Level::kAllMarkers);
    if (!options_.on_output) return;
    const SystemStepper::Observation now = stepper_->observation();
    const SystemStepper::EnergyFlow flow = calc_energy_flow();
    options_.on_output({.time = time,
                        .equations = now.equations,
                        .q = now.q,
                        .v = now.v,
                        .v_dot = now.v_dot,
                        .branches = piece().branches(),
                        .energy = {calc_stored(now), flow.dissipated, flow.input},
                        .modes = monitor_ ? &monitor_->modes() : nullptr,
                        .acceleration_error = reached_.next_output % kOutputsPerEstimate == 0
                                                  ? stepper_->estimate_acceleration_error()
                                                  : nullptr});
  }

  // At the end of a step.
  void observe_between() {
    if (!options_.on_time_between) return;
    stepper_->evaluate_end_approximately(SystemStepper::Level::kAllMarkers);
    const SystemStepper::Observation now = stepper_->observation();
    options_.on_time_between(stepper_->time(), now, calc_stored(now));
  }

  Energy calc_stored(const SystemStepper::Observation& now) {
    Energy stored = calc_energy(now.equations.terms(), piece().branches());
    stored.strain += now.held_strain;
    return stored;
  }

  const Model& model_;
  const TransientOptions& options_;
  Checkpoint reached_;                  // from which the stepper has started, but its counts are of now
  std::optional<ModeMonitor> monitor_;  // of modes left out, if asked for
  std::unique_ptr<SystemStepper> stepper_;
  const AdaptiveStepper* adaptive_ = nullptr;  // the stepper, where modes change
  double next_break_ = 0.0;                    // of a function of time
  double smooth_end_ = 0.0;                    // the next break, or the end
  double last_break_ = -std::numeric_limits<double>::infinity();
  long work_ = 0;  // steps and outputs since the last checkpoint
};

Eigen::Vector2d calc_acceleration_from(const SystemTerms& terms, const Eigen::VectorXd& v_dot,
                                       std::size_t marker) {
  const Model& model = terms.model();
  const int b = model.markers[marker].body;
  if (b == kGround) return Eigen::Vector2d::Zero();
  const Body& body = model.bodies[static_cast<std::size_t>(b)];
  return calc_marker_acceleration(terms.markers()[marker],
                                  v_dot.segment(body.first_coordinate, body.num_coordinates()));
}

}  // namespace

Eigen::Vector2d calc_acceleration(const ConstrainedEquations& equations, std::size_t marker) {
  return calc_acceleration_from(equations.terms(), equations.v_dot(), marker);
}

Eigen::Vector2d Snapshot::calc_acceleration_error(std::size_t marker) const {
  if (acceleration_error == nullptr) return Eigen::Vector2d::Zero();
  return calc_acceleration_from(terms(), *acceleration_error, marker) - terms().markers()[marker].a_bias;
}

TransientStatistics run_transient(const Model& model, const State& start, const TransientOptions& options) {
  return TransientRun(model, options).run(start);
}

TransientStatistics resume_transient(const Model& model, const Checkpoint& checkpoint,
                                     const TransientOptions& options) {
  if (!checkpoint.fits(model)) throw support::DamagedBytes();
  if (checkpoint.monitor.empty() == options.adaptivity.has_value()) throw support::DamagedBytes();
  return TransientRun(model, options).resume(checkpoint);
}

}  // namespace sprung::dynamics
