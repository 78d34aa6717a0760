#include "dynamics/simulation/monitored_stepper.h"

#include <optional>
#include <utility>

namespace sprung::dynamics {

MonitoredStepper::MonitoredStepper(std::unique_ptr<SystemStepper> stepper, const Model& model,
                                   ModeMonitor& monitor)
    : stepper_(std::move(stepper)),
      held_(match_modes(model, *monitor.modes().options().full)),
      monitor_(monitor) {}

void MonitoredStepper::start(const State& state) {
  const FullSmallMotion& full = monitor_.modes().indicator().small_motion();
  if (std::optional<KnownMotion> known = full.calc_held_motion(held_)) {
    stepper_->set_small_motion(std::move(*known));
  }
  stepper_->start(state);
}

// The forces may have jumped: the indicator has to know before the next step.
void MonitoredStepper::resume(double time, double end_time) {
  stepper_->evaluate(time, Level::kAccelerations);
  monitor_.update(time, held_, stepper_->equations());
  stepper_->resume(time, end_time);
}

Integrator::StepResult MonitoredStepper::step(double longest_step) {
  monitor_.begin_step();
  const Integrator::StepResult result = stepper_->step(longest_step);
  monitor_.follow_step(*stepper_, held_);
  monitor_.accept_step();
  return result;
}

}  // namespace sprung::dynamics
