#include "dynamics/simulation/adaptive_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/functions/find_zero.h"
#include "dynamics/integration/attempt.h"
#include "dynamics/simulation/make_stepper.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kAtRest = 1e-3;  // rate that counts as zero, of those at the ends of the step
constexpr int kMaxEvaluations = 12;

}  // namespace

AdaptiveStepper::AdaptiveStepper(const SteppingOptions& integrator, ModeMonitor& monitor, Listener listener)
    : integrator_(integrator), monitor_(monitor), listener_(std::move(listener)) {}

void AdaptiveStepper::start(const State& state) {
  segment_ = make_segment(state.time, state.branches);
}

// From where the motion is, with the modes that are active.
std::unique_ptr<AdaptiveStepper::Segment> AdaptiveStepper::make_segment(
    double time, const std::vector<int>& branches) const {
  FullMotion& motion = monitor_.motion();
  auto segment = std::make_unique<Segment>();
  segment->held = motion.hold(modes().active());
  segment->start = time;
  segment->num_modes = modes().num_active_modes();
  segment->held_strain = motion.calc_held_strain(modes().active());
  segment->stepper = make_stepper(segment->held.model, integrator_, listener_.on_repartition);
  if (std::optional<KnownMotion> known = modes().indicator().small_motion().calc_held_motion(segment->held)) {
    segment->stepper->set_small_motion(std::move(*known));
  }
  segment->stepper->start(motion.state_for(segment->held, time, branches));
  return segment;
}

void AdaptiveStepper::continue_with_active_modes(double time, const EnergyFlow& flow,
                                                 const std::vector<int>& branches) {
  active_time_ += segment_->num_modes * (time - segment_->start);
  work_before_ += segment_->stepper->statistics();
  flow_before_ = flow;
  segment_ = make_segment(time, branches);
  piece().update_next_break(time);
  evaluate(time, Level::kAccelerations);
  monitor_.update(time, segment_->held, equations());
  segment_->stepper->resume(time, end_time_);
}

SystemStepper::Observation AdaptiveStepper::observation() {
  const Observation now = segment_->stepper->observation();
  FullMotion& motion = monitor_.motion();
  motion.take(segment_->held, now.equations);
  return {.equations = now.equations,
          .q = motion.q(),
          .v = motion.v(),
          .v_dot = motion.v_dot(),
          .held_strain = segment_->held_strain};
}

// The forces may have jumped: the indicator has to know before the next step.
void AdaptiveStepper::resume(double time, double end_time) {
  end_time_ = end_time;
  rest_.reset();
  evaluate(time, Level::kAccelerations);
  monitor_.update(time, segment_->held, equations());
  segment_->stepper->resume(time, end_time);
}

SystemStepper::EnergyFlow AdaptiveStepper::energy_flow() const {
  const EnergyFlow flow = segment_->stepper->energy_flow();
  return {flow_before_.dissipated + flow.dissipated, flow_before_.input + flow.input};
}

SystemStepper::Statistics AdaptiveStepper::statistics() const {
  Statistics all = work_before_;
  all += segment_->stepper->statistics();
  return all;
}

double AdaptiveStepper::active_mode_time() const {
  return active_time_ + segment_->num_modes * (time() - segment_->start);
}

Integrator::StepResult AdaptiveStepper::step(double longest_step) {
  if (rest_) {
    let_idle_modes_leave();
    longest_step = std::min(longest_step, calc_longest_step());
  }
  while (true) {
    const std::optional<Integrator::StepResult> result =
        attempt_or_go_back([&] { return attempt_step(longest_step); }, [&] { go_back_to_start(); });
    if (result) return *result;
    repeat_with_missed_modes();
  }
}

// @return none if the step missed modes
std::optional<Integrator::StepResult> AdaptiveStepper::attempt_step(double longest_step) {
  step_start_.time = time();
  step_start_.rates = monitor_.rates();
  monitor_.get_state(step_start_.monitor);
  monitor_.begin_step();
  const Integrator::StepResult result = segment_->stepper->step(longest_step);
  const bool has_missed = monitor_.follow_step(*segment_->stepper, segment_->held);
  if (!has_missed) {
    monitor_.accept_step();
    if (result == Integrator::StepResult::kStepped) rest_ = find_rest_of_idle_modes();
    return result;
  }
  evaluate(step_start_.time, Level::kAccelerations);
  monitor_.motion().take(segment_->held, equations());
  step_start_.q = monitor_.motion().q();
  step_start_.v = monitor_.motion().v();
  step_start_.flow = energy_flow();
  step_start_.branches = piece().branches();
  if (!(step_start_.time < explored_until_)) explore_without_missed_modes(result);
  return std::nullopt;
}

void AdaptiveStepper::go_back_to_start() {
  monitor_.motion().go_to(step_start_.q, step_start_.v);
  monitor_.set_state(step_start_.monitor);
}

// Before modes join, the run continues without them for as long as they would stay. So all that will be
// wanted are found at once, and none that only seems large because the largest motion is still to come.
// Steps from the end of the step just made, through switches, up to the next break of a function of time.
void AdaptiveStepper::explore_without_missed_modes(Integrator::StepResult result) {
  SystemStepper& stepper = *segment_->stepper;
  explored_until_ = step_start_.time + modes().options().thresholds.residence;
  try {
    while (result != Integrator::StepResult::kEnded && time() < explored_until_) {
      if (result == Integrator::StepResult::kSwitched) {
        stepper.evaluate(time(), Level::kAccelerations);
        stepper.piece().update_branches(stepper.equations().terms());
        stepper.resume(time(), end_time_);
      }
      result = stepper.step(stepper.calc_longest_step());
      monitor_.follow_step(stepper, segment_->held);
    }
  } catch (const support::NumericalError&) {
    // It need not be possible without the modes.
  }
}

// The modes start where the step did, from where they are held, at rest, and the forces that held them fade.
// Modes that these call in turn join when the step itself shows it: by then the largest sizes are known.
void AdaptiveStepper::repeat_with_missed_modes() {
  const std::vector<int> missed = modes().find_missed(monitor_.largest());
  if (!missed.empty()) {
    let_join(missed);
    ++num_changes_;
  }
  continue_with_active_modes(step_start_.time, step_start_.flow, step_start_.branches);
}

// At the start of the step.
void AdaptiveStepper::let_join(const std::vector<int>& missed) {
  const double time = step_start_.time;
  std::vector<double> forces;
  for (const int coordinate : missed) {
    const ModeShare share = modes().share_of(coordinate, monitor_.largest());
    listener_.on_change(time, coordinate,
                        fmt::format("joins: {:.3g} % of the deflection, {:.3g} % of the acceleration",
                                    100.0 * share.deflection, 100.0 * share.acceleration));
    forces.push_back(-modes().held_force_of(coordinate));
  }
  monitor_.modes().activate(missed);
  const double duration = modes().calc_fading_time(missed, forces);
  if (!(duration > 0.0)) return;
  for (std::size_t i = 0; i < missed.size(); ++i)
    monitor_.motion().release(missed[i], forces[i], time, duration);
}

// The place in the step just made where idle modes leave: the rate of the slowest passes zero.
std::optional<double> AdaptiveStepper::find_rest_of_idle_modes() {
  idle_ = modes().find_idle();
  if (idle_.empty()) return std::nullopt;
  const int slowest = *std::min_element(idle_.begin(), idle_.end(), [this](int a, int b) {
    return modes().frequency_of(a) < modes().frequency_of(b);
  });
  if (step_start_.rates[slowest] * monitor_.rates()[slowest] > 0.0) return std::nullopt;
  return find_rest(slowest);
}

// The step is shortened to end at rest_. No position jumps there; the rates of those idle modes that are not
// at rest, below the drop threshold, are stopped with the momentum kept and the energy booked.
void AdaptiveStepper::let_idle_modes_leave() {
  const double rest = *rest_;
  rest_.reset();
  evaluate(rest, Level::kAccelerations);
  FullMotion& motion = monitor_.motion();
  motion.take(segment_->held, equations());
  const std::vector<int> leaving = modes().find_stoppable(idle_, motion.v());
  monitor_.set_state(step_start_.monitor);
  monitor_.update(rest, segment_->held, equations());
  if (leaving.empty()) {
    segment_->stepper->resume(rest, end_time_);
    return;
  }
  EnergyFlow flow = energy_flow();
  const std::vector<int> branches = piece().branches();
  const double lost = monitor_.let_leave(leaving, branches);
  flow.dissipated += lost;
  for (const int coordinate : leaving) {
    listener_.on_change(rest, coordinate,
                        fmt::format("leaves: below {:.2g} %; energy lost by all that leave {:.1e} J",
                                    100.0 * modes().options().thresholds.drop, lost));
  }
  ++num_changes_;
  continue_with_active_modes(rest, flow, branches);
}

double AdaptiveStepper::rate_of(int coordinate) const {
  const std::vector<int>& places = segment_->held.coordinates;
  return equations().v()[std::lower_bound(places.begin(), places.end(), coordinate) - places.begin()];
}

// The place where a modal rate is zero within the step just made. The equations are evaluated there.
std::optional<double> AdaptiveStepper::find_rest(int coordinate) {
  const auto rate_at = [&](double time) {
    evaluate(time, Level::kAccelerations);
    return rate_of(coordinate);
  };
  const double low = step_start_.time, high = time();
  const double rate_low = rate_at(low), rate_high = rate_at(high);
  if (rate_low * rate_high > 0.0) return std::nullopt;
  const double small = kAtRest * std::max(std::abs(rate_low), std::abs(rate_high));
  return find_zero(rate_at, {low, rate_low, high, rate_high},
                   {.value = small, .max_evaluations = kMaxEvaluations});
}

}  // namespace sprung::dynamics
