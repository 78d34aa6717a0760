#include "dynamics/integration/partitioned/partitioned_stepper.h"

#include <algorithm>
#include <utility>

#include "dynamics/integration/partitioned/make_integrator.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPartitionDecay = 3.0;  // partition_decay() at which another one is chosen
constexpr double kSamePlace = 1e-9;      // s

}  // namespace

PartitionedStepper::PartitionedStepper(const Model& model, const Integrator::Options& options,
                                       std::function<void(double)> on_repartition)
    : ode_(model), integrator_(make_integrator(ode_, options)), on_repartition_(std::move(on_repartition)) {}

std::optional<KnownMotion> PartitionedStepper::small_motion() const {
  const SmallMotion* motion = integrator_->small_motion();
  if (motion == nullptr) return std::nullopt;
  return KnownMotion{ode_.equations().partition().independent, *motion};
}

void PartitionedStepper::start(const State& state) {
  ode_.set_state(state, 0.0, 0.0);
  y_.assign(ode_.y().begin(), ode_.y().end());
  start_time_ = state.time;
  is_running_ = false;
}

void PartitionedStepper::resume(double time, double end_time) {
  end_time_ = end_time;
  integrator_->start(time, y_, end_time_);
  is_running_ = true;
}

// An independent coordinate may come to a turning point of the mechanism, beyond which there is no position,
// before the decay of the partition shows. Then the integrator fails, and continues with another partition.
Integrator::StepResult PartitionedStepper::step(double longest_step) {
  if (ode_.equations().partition_decay() > kPartitionDecay) choose_partition();
  ode_.equations().accept_motion();
  try {
    return integrator_->step(longest_step);
  } catch (const support::NumericalError&) {
    if (time() - last_rescue_ < kSamePlace) throw;
    last_rescue_ = time();
    choose_partition();
    return Integrator::StepResult::kStepped;
  }
}

void PartitionedStepper::choose_partition() {
  const double now = time();
  y_.assign(integrator_->y().begin(), integrator_->y().end());
  ode_.set_state(ode_.make_state(now, y_), ode_.dissipated(y_), ode_.input(y_));
  ++repartitions_;
  if (on_repartition_) on_repartition_(now);
  integrator_->start(now, ode_.y(), end_time_);
}

void PartitionedStepper::evaluate(double time, Level level) {
  if (is_running_) {
    if (time >= integrator_->time())
      std::copy(integrator_->y().begin(), integrator_->y().end(), y_.begin());
    else
      integrator_->interpolate(time, y_);
  }
  if (level == Level::kMotion)
    ode_.close_joints(time, y_);
  else
    ode_.make_state(time, y_);
  if (level == Level::kAllMarkers) ode_.equations().update_all_markers();
}

void PartitionedStepper::evaluate_end_approximately() {
  if (!ode_.has_accelerations(time())) evaluate(time(), Level::kAccelerations);
}

SystemStepper::Statistics PartitionedStepper::statistics() const {
  return {.integrator = integrator_->statistics(),
          .evaluations = ode_.num_derivatives(),
          .repartitions = repartitions_};
}

}  // namespace sprung::dynamics
