#include "dynamics/analysis/transient.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPartitionDecay = 3.0;    // partition_decay() at which another one is chosen
constexpr int kMaxSwitchesInPlace = 100;   // switches within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;        // s

class TransientRun {
 public:
  TransientRun(const Model& model, const TransientOptions& options)
      : options_(options), ode_(model), integrator_(make_integrator(ode_, options.integrator)) {}

  TransientStatistics run(const State& start) {
    find_end_of_smoothness(start.time);
    ode_.set_state(start, 0.0, 0.0);
    ode_.make_state(start.time, ode_.y());
    ode_.update_branches();
    y_.assign(ode_.y().begin(), ode_.y().end());
    start_time_ = start.time;
    write_outputs(start.time, ode_.y());
    if (start.time < options_.end_time) {
      integrator_->start(start.time, ode_.y(), smooth_end_);
      integrate();
    }
    statistics_.integrator = integrator_->statistics();
    statistics_.evaluations = ode_.num_derivatives();
    return statistics_;
  }

 private:
  void integrate() {
    while (true) {
      const double longest = std::min(options_.largest_step, ode_.calc_longest_step());
      const Integrator::StepResult result = take_step(longest);
      write_outputs(integrator_->time(), {});
      if (options_.on_step && !options_.on_step(integrator_->time())) return;
      if (result == Integrator::StepResult::kEnded) {
        if (smooth_end_ >= options_.end_time) break;
        take_break();
      } else if (result == Integrator::StepResult::kSwitched) {
        take_switch();
      } else if (ode_.equations().partition_decay() > kPartitionDecay) {
        choose_partition();
      }
    }
    statistics_.completed = true;
  }

  // A coordinate that is integrated may come to a turning point of the mechanism faster than the partition is seen to
  // grow bad: beyond it no position can be found. Another partition goes on from there.
  Integrator::StepResult take_step(double longest) {
    try {
      return integrator_->step(longest);
    } catch (const support::NumericalError&) {
      if (integrator_->time() - last_rescue_ < kSamePlace) throw;
      last_rescue_ = integrator_->time();
      choose_partition();
      return Integrator::StepResult::kStepped;
    }
  }

  // Functions of time are smooth from `time` to the next of their breaks: the integrator goes no further in one go.
  void find_end_of_smoothness(double time) {
    double next = ode_.update_next_break(time);
    while (next - time < kSamePlace) next = ode_.update_next_break(next);  // too short to be integrated
    smooth_end_ = std::min(options_.end_time, next);
  }

  void take_break() {
    const double time = smooth_end_;
    y_.assign(integrator_->y().begin(), integrator_->y().end());
    start_anew(time);
  }

  // Goes on from y_ with the branches that hold there.
  void start_anew(double time) {
    find_end_of_smoothness(time);
    ode_.make_state(time, y_);
    for (const BranchChange& change : ode_.update_branches()) {
      if (options_.on_event) options_.on_event({time, "switch", change.element, change.text});
    }
    integrator_->start(time, y_, smooth_end_);
  }

  void take_switch() {
    const double time = integrator_->time();
    num_in_place_ = time - last_switch_ > kSamePlace ? 0 : num_in_place_ + 1;
    if (num_in_place_ > kMaxSwitchesInPlace) {
      throw support::NumericalError(
          fmt::format("a force switches back and forth without end at t = {:.9g} s; look at tyres and road there", time));
    }
    last_switch_ = time;
    ++statistics_.switches;
    y_.assign(integrator_->y().begin(), integrator_->y().end());
    start_anew(time);
  }

  void choose_partition() {
    const double time = integrator_->time();
    y_.assign(integrator_->y().begin(), integrator_->y().end());
    const State state = ode_.make_state(time, y_);
    ode_.set_state(state, ode_.dissipated(y_), ode_.input(y_));
    ++statistics_.repartitions;
    if (options_.on_event) options_.on_event({time, "partition", "", "independent coordinates chosen anew"});
    integrator_->start(time, ode_.y(), smooth_end_);
  }

  // Writes every output time up to `time`; the last one exactly at the end.
  // @param y  the solution at `time`; empty: interpolated from the last step
  void write_outputs(double time, std::span<const double> y) {
    const double tolerance = 1e-9 * options_.output_step;
    while (true) {
      double next = start_time_ + static_cast<double>(next_output_) * options_.output_step;
      if (next > options_.end_time + tolerance || next > time + tolerance) return;
      next = std::min(next, time);
      if (y.empty()) integrator_->interpolate(next, y_);
      else y_.assign(y.begin(), y.end());
      write_output(next);
      ++next_output_;
    }
  }

  void write_output(double time) {
    ode_.make_state(time, y_);
    ode_.equations().update_all_markers();
    ++statistics_.output_evaluations;
    if (!options_.on_output) return;
    options_.on_output({.time = time,
                        .equations = ode_.equations(),
                        .branches = ode_.branches(),
                        .energy = {calc_energy(ode_.equations().terms(), ode_.branches()), ode_.dissipated(y_),
                                   ode_.input(y_)}});
  }

  const TransientOptions& options_;
  PartitionedOde ode_;
  std::unique_ptr<Integrator> integrator_;
  TransientStatistics statistics_;
  std::vector<double> y_;
  double start_time_ = 0.0;
  double smooth_end_ = 0.0;  // the next break of a function of time, or the end
  double last_switch_ = -std::numeric_limits<double>::infinity();
  double last_rescue_ = -std::numeric_limits<double>::infinity();
  int num_in_place_ = 0;
  long next_output_ = 0;
};

}  // namespace

TransientStatistics run_transient(const Model& model, const State& start, const TransientOptions& options) {
  return TransientRun(model, options).run(start);
}

}  // namespace sprung::dynamics
