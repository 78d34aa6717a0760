#include "dynamics/simulation/adaptive_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/functions/find_zero.h"
#include "dynamics/simulation/make_stepper.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kLongestUnseen = 4e-3;  // s between updates of the indicator
constexpr double kMostParts = 8.0;       // of a step, between which the indicator is updated
constexpr double kAtRest = 1e-3;         // rate that counts as none, of those at the ends of the step
constexpr int kMaxSearch = 12;

// What the indicator refers to at the start: the full model, in which modes that the run lacks stand at zero.
State expand(const Model& model, const AdaptivityOptions& options, const State& start) {
  if (options.changes) return start;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(options.full->num_coordinates);
  State full{.time = start.time, .q = zero, .v = zero, .branches = start.branches};
  const HeldModes held = match_modes(model, *options.full);
  put_active(held, start.q, full.q);
  put_active(held, start.v, full.v);
  return full;
}

}  // namespace

AdaptiveStepper::AdaptiveStepper(const Model& model, const SteppingOptions& integrator,
                                 const AdaptivityOptions& options, Listener listener)
    : model_(&model), integrator_(integrator), options_(options), listener_(std::move(listener)) {}

void AdaptiveStepper::start(const State& state) {
  const State full = expand(*model_, options_, state);
  modes_.emplace(options_, full);
  motion_.emplace(*options_.full, full);
  leg_ = make_leg(options_.changes ? motion_->hold(modes_->active()) : match_modes(*model_, *options_.full),
                  state.time, state.branches);
  start_time_ = step_start_ = state.time;
}

std::unique_ptr<AdaptiveStepper::Leg> AdaptiveStepper::make_leg(HeldModes held, double time,
                                                                const std::vector<int>& branches) const {
  auto leg = std::make_unique<Leg>();
  leg->held = std::move(held);
  leg->start = time;
  leg->num_modes = modes_->num_active_modes();
  if (options_.changes) leg->held_strain = motion_->calc_held_strain(modes_->active());
  const Model& model = options_.changes ? leg->held.model : *model_;
  leg->stepper = make_stepper(model, integrator_, listener_.on_repartition);
  if (std::optional<KnownMotion> known = modes_->indicator().calc_small_motion(leg->held)) {
    leg->stepper->set_small_motion(std::move(*known));
  }
  leg->stepper->start(motion_->state_for(leg->held, time, branches));
  return leg;
}

void AdaptiveStepper::evaluate(double time, Level level) {
  leg_->stepper->evaluate(time, level);
}

SystemStepper::Observation AdaptiveStepper::observation() {
  Observation now = leg_->stepper->observation();
  if (!options_.changes) return now;
  motion_->take(leg_->held, now.equations);
  return {.equations = now.equations,
          .q = motion_->q(),
          .v = motion_->v(),
          .v_dot = motion_->v_dot(),
          .held_strain = leg_->held_strain};
}

// The forces may have jumped: the indicator has to know before the next step.
void AdaptiveStepper::resume(double time, double end_time) {
  end_time_ = end_time;
  rest_.reset();
  evaluate(time, Level::kAccelerations);
  watch(time);
  leg_->stepper->resume(time, end_time);
}

SystemStepper::EnergyFlow AdaptiveStepper::energy_flow() const {
  const EnergyFlow flow = leg_->stepper->energy_flow();
  return {flow_before_.dissipated + flow.dissipated, flow_before_.input + flow.input};
}

SystemStepper::Statistics AdaptiveStepper::statistics() const {
  Statistics all = work_before_;
  all += leg_->stepper->statistics();
  return all;
}

double AdaptiveStepper::mean_active_modes() const {
  const double length = time() - start_time_;
  return length > 0.0 ? (active_time_ + leg_->num_modes * (time() - leg_->start)) / length : leg_->num_modes;
}

Integrator::StepResult AdaptiveStepper::step(double longest_step) {
  if (rest_) {
    let_modes_go();
    longest_step = std::min(longest_step, calc_longest_step());
  }
  while (true) {
    step_start_ = time();
    modes_->remember(memory_);
    largest_.clear();
    modes_->raise(largest_);
    const Integrator::StepResult result = leg_->stepper->step(longest_step);
    if (!follow_step()) {
      modes_->note(time(), largest_);
      if (result == Integrator::StepResult::kStepped) rest_ = find_rest();
      return result;
    }
    take_back(result);
  }
}

// Brings the indicator to where the equations are.
void AdaptiveStepper::watch(double time) {
  motion_->take(leg_->held, equations());
  modes_->update(time, equations(), motion_->q(), motion_->v(), motion_->v_dot());
  watched_time_ = time;
  rates_ = motion_->v();
}

// Brings the indicator through the step just made. @return true if modes were missed in it
bool AdaptiveStepper::follow_step() {
  const double begin = watched_time_, end = time(), length = end - begin;
  if (!(length > 0.0)) return false;
  rates_before_ = rates_;
  const int parts = static_cast<int>(std::clamp(std::ceil(length / kLongestUnseen), 1.0, kMostParts));
  bool misses = options_.changes && modes_->misses_any();  // forces may have jumped at its start
  for (int i = 1; i <= parts; ++i) {
    const double time = i == parts ? end : begin + length * i / parts;
    if (i == parts) {
      leg_->stepper->evaluate_end_approximately();
    } else {
      leg_->stepper->evaluate(time, Level::kAccelerations);
    }
    watch(time);
    modes_->raise(largest_);
    misses |= options_.changes && modes_->misses_any();
  }
  return misses;
}

// Before modes join, the run goes on without them for as long as they would stay: so all that will be wanted
// are found at once, and none that only seems large because what is to come has not come yet. Then they start
// where the step did, from where they are held, at rest, and the force that held them fades. What those call
// in turn joins as the step itself tells: how large all becomes is known by then.
void AdaptiveStepper::take_back(Integrator::StepResult result) {
  evaluate(step_start_, Level::kAccelerations);
  motion_->take(leg_->held, equations());
  const Eigen::VectorXd q = motion_->q(), v = motion_->v();
  const EnergyFlow flow = energy_flow();
  const std::vector<int> branches = piece().branches();
  if (!(step_start_ < looked_until_)) {
    look_ahead(result, step_start_ + options_.thresholds.residence);
    looked_until_ = step_start_ + options_.thresholds.residence;
  }
  motion_->go_to(q, v);
  modes_->go_back(memory_);
  const std::vector<int> missed = modes_->find_missed(largest_);
  if (!missed.empty()) {
    let_join(missed);
    ++num_changes_;
  }
  go_on(motion_->hold(modes_->active()), step_start_, flow, branches);
}

// At the start of the step.
void AdaptiveStepper::let_join(const std::vector<int>& missed) {
  std::vector<double> forces;
  for (const int coordinate : missed) {
    const ModeShare share = modes_->share_of(coordinate, largest_);
    listener_.on_change(step_start_, coordinate,
                        fmt::format("joins: {:.3g} % of the deflection, {:.3g} % of the acceleration",
                                    100.0 * share.deflection, 100.0 * share.acceleration));
    forces.push_back(-modes_->held_force_of(coordinate));
  }
  modes_->activate(missed);
  const double duration = modes_->calc_release_time(missed, forces);
  if (!(duration > 0.0)) return;
  for (std::size_t i = 0; i < missed.size(); ++i)
    motion_->release(missed[i], forces[i], step_start_, duration);
}

// Steps on from the end of the step that was made, through switches, up to the next break of a function of
// time.
void AdaptiveStepper::look_ahead(Integrator::StepResult result, double until) {
  SystemStepper& stepper = *leg_->stepper;
  try {
    while (result != Integrator::StepResult::kEnded && time() < until) {
      if (result == Integrator::StepResult::kSwitched) {
        stepper.evaluate(time(), Level::kAccelerations);
        stepper.piece().update_branches(stepper.equations().terms());
        stepper.resume(time(), end_time_);
      }
      result = stepper.step(stepper.calc_longest_step());
      follow_step();
    }
  } catch (const support::NumericalError&) {
    // It need not be possible without the modes.
  }
}

// From where the motion is.
void AdaptiveStepper::go_on(HeldModes held, double time, const EnergyFlow& flow,
                            const std::vector<int>& branches) {
  active_time_ += leg_->num_modes * (time - leg_->start);
  work_before_ += leg_->stepper->statistics();
  flow_before_ = flow;
  leg_ = make_leg(std::move(held), time, branches);
  piece().update_next_break(time);
  evaluate(time, Level::kAccelerations);
  watch(time);
  leg_->stepper->resume(time, end_time_);
}

// Where idle modes leave within the step just made: the rate of the slowest passes zero. The step ends there.
std::optional<double> AdaptiveStepper::find_rest() {
  if (!options_.changes) return std::nullopt;
  idle_ = modes_->find_idle();
  if (idle_.empty()) return std::nullopt;
  const int slowest = *std::min_element(idle_.begin(), idle_.end(), [this](int a, int b) {
    return modes_->frequency_of(a) < modes_->frequency_of(b);
  });
  if (rates_before_[slowest] * rates_[slowest] > 0.0) return std::nullopt;
  return find_rest_of(slowest);
}

// At rest_. No position jumps; the rates of idle modes other than the slowest, below the drop threshold, are
// stopped with the momentum kept and the energy booked.
void AdaptiveStepper::let_modes_go() {
  const double rest = *rest_;
  rest_.reset();
  evaluate(rest, Level::kAccelerations);
  motion_->take(leg_->held, equations());
  const std::vector<int> leaving = modes_->find_stoppable(idle_, motion_->v());
  modes_->go_back(memory_);
  watch(rest);
  if (leaving.empty()) {
    leg_->stepper->resume(rest, end_time_);
    return;
  }
  modes_->deactivate(leaving);
  HeldModes held = motion_->hold(modes_->active());
  EnergyFlow flow = energy_flow();
  const double lost = motion_->stop(leaving, held, rest, piece().branches());
  flow.dissipated += lost;
  for (const int coordinate : leaving) {
    listener_.on_change(rest, coordinate,
                        fmt::format("leaves: below {:.2g} %; energy lost by all that leave {:.1e} J",
                                    100.0 * options_.thresholds.drop, lost));
  }
  ++num_changes_;
  const std::vector<int> branches = piece().branches();
  go_on(std::move(held), rest, flow, branches);
}

double AdaptiveStepper::rate_of(int coordinate) const {
  const std::vector<int>& places = leg_->held.coordinates;
  return equations().v()[std::lower_bound(places.begin(), places.end(), coordinate) - places.begin()];
}

// Where a modal rate is zero within the step just made. The equations are evaluated there.
std::optional<double> AdaptiveStepper::find_rest_of(int coordinate) {
  const auto rate_at = [&](double time) {
    evaluate(time, Level::kAccelerations);
    return rate_of(coordinate);
  };
  const double low = step_start_, high = time();
  const double rate_low = rate_at(low), rate_high = rate_at(high);
  if (rate_low * rate_high > 0.0) return std::nullopt;
  const double small = kAtRest * std::max(std::abs(rate_low), std::abs(rate_high));
  return find_zero(rate_at, {low, rate_low, high, rate_high},
                   {.value = small, .max_evaluations = kMaxSearch});
}

}  // namespace sprung::dynamics
