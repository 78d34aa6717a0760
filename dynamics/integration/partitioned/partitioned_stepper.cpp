#include "dynamics/integration/partitioned/partitioned_stepper.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "dynamics/integration/partitioned/make_integrator.h"
#include "dynamics/system/partition.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPartitionDecay = 3.0;  // partition_decay() at which another one is chosen
constexpr double kSamePlace = 1e-9;      // s
// Smallest pivot, of its usual size, at which a change point is passed: nearer to it rounding grows
// in the dependent coordinates, farther from it the step is longer.
constexpr double kChangePoint = 1e-3;
constexpr double kSmallPivot = 0.1;  // likewise, at which a partition becomes better as the motion leads away
constexpr double kUntilRenewal = 50.0;  // steps over a change point, until the partition is chosen well

}  // namespace

PartitionedStepper::PartitionedStepper(const Model& model, const Integrator::Options& options,
                                       std::function<void(double)> on_repartition)
    : model_(&model),
      ode_(model),
      integrator_(make_integrator(ode_, options)),
      on_repartition_(std::move(on_repartition)) {}

std::optional<KnownMotion> PartitionedStepper::small_motion() const {
  const SmallMotion* motion = integrator_->small_motion();
  if (motion == nullptr) return std::nullopt;
  return KnownMotion{ode_.equations().partition().independent, *motion};
}

void PartitionedStepper::start(const State& state) {
  ode_.set_state(state, 0.0, 0.0);
  last_pivot_ = best_pivot_ = ode_.equations().partition().smallest_pivot;
  has_passed_ = may_improve_ = false;
  usual_pivot_.reset();
  renewal_time_ = std::numeric_limits<double>::infinity();
  is_at_start_ = true;
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
  if (has_passed_) ode_.equations().return_to_accepted();
  has_passed_ = false;
  bool is_near = false;
  if (std::exchange(is_at_start_, false)) {
    const double share = calc_pivot_share();
    is_near = share < kChangePoint;
    may_improve_ = may_improve_ || share < kSmallPivot;
  }
  if (ode_.equations().partition_decay() > kPartitionDecay || time() >= renewal_time_) {
    const double before = last_pivot_;
    choose_partition();
    is_near = last_pivot_ < before && calc_pivot_share() < kChangePoint;
  }
  if (is_near && pass_change_point(longest_step)) return end_passage();
  // A partition that was chosen beside a change point becomes better before it decays.
  if (may_improve_) ode_.equations().mark_if_best();
  ode_.equations().accept_motion();
  try {
    return integrator_->step(longest_step);
  } catch (const support::NumericalError&) {
    if (time() - last_rescue_ < kSamePlace) {
      if (pass_change_point(longest_step)) return end_passage();
      throw;
    }
    last_rescue_ = time();
    choose_partition();
    return Integrator::StepResult::kStepped;
  }
}

// Smallest pivot of the partition chosen last, of its usual size: the largest that it had in the run is
// small, too, where the run starts beside a change point. 1 where it is not small.
double PartitionedStepper::calc_pivot_share() {
  if (last_pivot_ >= kSmallPivot) return 1.0;
  if (!usual_pivot_) usual_pivot_ = calc_usual_pivot(*model_, equations().terms().time(), equations().q());
  return last_pivot_ / std::max(best_pivot_, *usual_pivot_);
}

void PartitionedStepper::choose_partition() {
  const double now = time();
  y_.assign(integrator_->y().begin(), integrator_->y().end());
  ode_.set_state(ode_.make_state(now, y_), ode_.dissipated(y_), ode_.input(y_));
  last_pivot_ = ode_.equations().partition().smallest_pivot;
  best_pivot_ = std::max(best_pivot_, last_pivot_);
  renewal_time_ = std::numeric_limits<double>::infinity();
  ++repartitions_;
  if (on_repartition_) on_repartition_(now);
  integrator_->start(now, ode_.y(), end_time_);
}

// A step over a position at which no choice of independent coordinates is good.
bool PartitionedStepper::pass_change_point(double longest_step) {
  const double now = time();
  y_.assign(integrator_->y().begin(), integrator_->y().end());
  State state;
  try {
    state = ode_.make_state(now, y_);
  } catch (const support::NumericalError&) {
    return false;
  }
  may_improve_ = true;
  if (!change_point_) change_point_.emplace(*model_);
  change_point_->terms().set_fading_forces(state.fading);
  if (!change_point_->pass(equations(), ode_.equations().partition(), state.branches,
                           std::min(longest_step, end_time_ - now)))
    return false;
  const ChangePointStep::End &begin = change_point_->begin(), &end = change_point_->end();
  flow_before_ = {ode_.dissipated(y_), ode_.input(y_)};
  state.time = end.time;
  state.q = end.q;
  state.v = end.v;
  const Eigen::Vector2d flow = flow_before_ + change_point_->calc_work(end.time);
  ode_.set_state(state, flow[0], flow[1]);
  last_pivot_ = ode_.equations().partition().smallest_pivot;
  renewal_time_ = end.time + kUntilRenewal * (end.time - begin.time);
  ++repartitions_;
  if (on_repartition_) on_repartition_(end.time);
  integrator_->start(end.time, ode_.y(), end_time_);
  has_passed_ = true;
  return true;
}

Integrator::StepResult PartitionedStepper::end_passage() {
  if (time() >= end_time_) return Integrator::StepResult::kEnded;
  std::vector<double> values(static_cast<std::size_t>(piece().num_switches()));
  ode_.calc_switches(time(), integrator_->y(), values);
  const bool has_switched =
      std::any_of(values.begin(), values.end(), [](double value) { return value < 0.0; });
  return has_switched ? Integrator::StepResult::kSwitched : Integrator::StepResult::kStepped;
}

void PartitionedStepper::evaluate_passage(double time) {
  change_point_->interpolate(time, inside_);
  ode_.equations().all_coordinates().set_motion(ode_.piece().evaluation_time(time), inside_.q, inside_.v,
                                                inside_.v_dot, inside_.lambda, ode_.piece().branches());
  y_.assign(integrator_->y().begin(), integrator_->y().end());
  const Eigen::Vector2d flow = flow_before_ + change_point_->calc_work(time);
  std::copy(flow.begin(), flow.end(), y_.end() - 2);
}

void PartitionedStepper::evaluate(double time, Level level) {
  evaluated_time_ = time;
  if (has_passed_) ode_.equations().return_to_accepted();
  if (is_inside_passage(time)) {
    evaluate_passage(time);
    if (level == Level::kAllMarkers) ode_.equations().update_all_markers();
    return;
  }
  if (is_running_) {
    if (time >= integrator_->time())
      std::copy(integrator_->y().begin(), integrator_->y().end(), y_.begin());
    else
      integrator_->interpolate(time, y_);
  }
  if (level == Level::kMotion)
    ode_.close_joints(time, y_);
  else
    ode_.calc_accelerations(time, y_);
  if (level == Level::kAllMarkers) ode_.equations().update_all_markers();
}

void PartitionedStepper::evaluate_end_approximately(Level level) {
  if (!ode_.has_accelerations(time())) {
    evaluate(time(), level);
  } else if (level == Level::kAllMarkers) {
    ode_.equations().update_all_markers();
  }
}

const Eigen::VectorXd* PartitionedStepper::estimate_acceleration_error() {
  if (!is_running_ || is_inside_passage(evaluated_time_)) return nullptr;
  if (!integrator_->estimate_acceleration_error(evaluated_time_, independent_error_)) return nullptr;
  acceleration_error_ = ode_.equations().calc_free_motion(independent_error_);
  return &acceleration_error_;
}

SystemStepper::Statistics PartitionedStepper::statistics() const {
  return {.integrator = integrator_->statistics(),
          .evaluations = ode_.num_derivatives(),
          .repartitions = repartitions_};
}

}  // namespace sprung::dynamics
