#include "dynamics/analysis/transient.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxSwitchesInPlace =
    100;                             // switches within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;  // s

class TransientRun {
 public:
  TransientRun(const Model& model, const TransientOptions& options)
      : options_(options), stepper_(make_stepper(model, options.integrator, [this](double time) {
          tell({time, "partition", "", "independent coordinates chosen anew"});
        })) {}

  TransientStatistics run(const State& start) {
    find_end_of_smoothness(start.time);
    stepper_->start(start);
    stepper_->evaluate(start.time);
    piece().update_branches(stepper_->equations().terms());
    start_time_ = start.time;
    write_outputs(start.time);
    if (start.time < options_.end_time) {
      stepper_->resume(smooth_end_);
      integrate();
    }
    statistics_.stepper = stepper_->statistics();
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
    double next = piece().update_next_break(time);
    while (next - time < kSamePlace) next = piece().update_next_break(next);  // too short to be integrated
    smooth_end_ = std::min(options_.end_time, next);
  }

  // Goes on with the branches that hold at the end of the last step.
  void start_anew(double time) {
    find_end_of_smoothness(time);
    stepper_->evaluate(time);
    for (const BranchChange& change : piece().update_branches(stepper_->equations().terms())) {
      tell({time, "switch", change.element, change.text});
    }
    stepper_->resume(smooth_end_);
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
    stepper_->evaluate(time);
    ++statistics_.output_evaluations;
    if (!options_.on_output) return;
    const ConstrainedEquations& equations = stepper_->equations();
    const SystemStepper::EnergyFlow flow = stepper_->energy_flow();
    options_.on_output(
        {.time = time,
         .terms = equations.terms(),
         .q = equations.q(),
         .v = equations.v(),
         .v_dot = equations.v_dot(),
         .multipliers = equations.multipliers(),
         .branches = piece().branches(),
         .energy = {calc_energy(equations.terms(), piece().branches()), flow.dissipated, flow.input}});
  }

  const TransientOptions& options_;
  std::unique_ptr<SystemStepper> stepper_;
  TransientStatistics statistics_;
  double start_time_ = 0.0;
  double smooth_end_ = 0.0;  // the next break of a function of time, or the end
  double last_switch_ = -std::numeric_limits<double>::infinity();
  int num_in_place_ = 0;
  long next_output_ = 0;
};

}  // namespace

TransientStatistics run_transient(const Model& model, const State& start, const TransientOptions& options) {
  return TransientRun(model, options).run(start);
}

}  // namespace sprung::dynamics
