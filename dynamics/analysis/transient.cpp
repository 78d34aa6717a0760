#include "dynamics/analysis/transient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "dynamics/analysis/mode_changes.h"
#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxSwitchesInPlace =
    100;                             // switches within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;  // s
constexpr double kLongestUnseen = 2e-3;  // s between updates of the indicator of modes

class TransientRun {
 public:
  TransientRun(const Model& model, const TransientOptions& options) : model_(model), options_(options) {}

  TransientStatistics run(const State& start) {
    start_time_ = mean_since_ = step_start_.time = start.time;
    State state = start;
    if (options_.adaptivity) {
      modes_.emplace(model_, *options_.adaptivity, start);
      state = modes_->can_change() ? modes_->stepped_state(start.time, start.branches) : start;
      num_active_modes_ = modes_->adaptation().num_active_modes();
    }
    take_stepper(state);
    piece().update_branches(stepper_->equations().terms());
    if (modes_) {
      stepper_->evaluate(start.time);  // with these branches
      modes_->update(start.time, stepper_->equations(), piece().branches());
      mark_step_start(start.time);
    }
    write_outputs(start.time);
    if (start.time < options_.end_time) {
      stepper_->resume(smooth_end_);
      integrate();
    }
    count_work();
    if (modes_) finish_modes();
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
      if (modes_ && !follow_modes(time)) continue;
      write_outputs(time);
      if (options_.on_step && !options_.on_step(time)) return;
      if (modes_ && modes_->can_change() && result != Integrator::StepResult::kSwitched && let_modes_go(time)) continue;
      if (modes_) mark_step_start(time);
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
    const bool changes = modes_ && modes_->can_change();
    if (changes) modes_->take(equations);
    const SystemTerms& terms = changes ? modes_->calc_full_terms(time) : equations.terms();
    const SystemStepper::EnergyFlow flow = total_flow();
    options_.on_output({.time = time,
                        .terms = terms,
                        .q = changes ? modes_->q() : equations.q(),
                        .v = changes ? modes_->v() : equations.v(),
                        .v_dot = changes ? modes_->v_dot() : equations.v_dot(),
                        .multipliers = equations.multipliers(),
                        .branches = piece().branches(),
                        .energy = {calc_energy(terms, piece().branches()), flow.dissipated, flow.input},
                        .modes = modes_ ? &modes_->adaptation() : nullptr});
  }

  void take_stepper(const State& state) {
    stepper_ = make_stepper(modes_ ? modes_->stepped_model() : model_, options_.integrator, [this](double time) {
      tell({time, "partition", "", "independent coordinates chosen anew"});
    });
    find_end_of_smoothness(state.time);
    stepper_->start(state);
    stepper_->evaluate(state.time);
  }

  SystemStepper::EnergyFlow total_flow() const {
    const SystemStepper::EnergyFlow flow = stepper_->energy_flow();
    return {flow_before_.dissipated + flow.dissipated, flow_before_.input + flow.input};
  }

  // Adds the work of a stepper that is about to go.
  void count_work() {
    const SystemStepper::Statistics work = stepper_->statistics();
    SystemStepper::Statistics& all = statistics_.stepper;
    all.integrator.steps += work.integrator.steps;
    all.integrator.error_test_failures += work.integrator.error_test_failures;
    all.integrator.iteration_failures += work.integrator.iteration_failures;
    all.integrator.restarts += work.integrator.restarts;
    all.evaluations += work.evaluations;
    all.repartitions += work.repartitions;
    all.velocity_violation = std::max(all.velocity_violation, work.velocity_violation);
  }

  // ---- modes that join and leave

  // What a step that missed a mode is taken back to.
  struct StepStart {
    double time = 0.0;
    SystemStepper::EnergyFlow flow;
    std::shared_ptr<const ModeChanges::Memory> memory;
  };

  // After modes_->update at that time.
  void mark_step_start(double time) {
    step_start_.time = time;
    if (!modes_->can_change()) return;
    stepper_->evaluate(time);  // outputs may have been written since
    modes_->take(stepper_->equations());
    step_start_ = {time, total_flow(), modes_->remember()};
  }

  // Brings the indicator to the end of the step just made. @return false if a mode was missed in it: then the step was
  // taken back, and the run goes on from its start with that mode
  bool follow_modes(double end) {
    const double begin = step_start_.time, length = end - begin;
    if (!(length > 0.0)) return true;
    const int parts = static_cast<int>(std::clamp(std::ceil(length / kLongestUnseen), 1.0, 8.0));
    for (int i = 1; i <= parts; ++i) {
      const double time = i == parts ? end : begin + length * i / parts;
      stepper_->evaluate(time);
      modes_->update(time, stepper_->equations(), piece().branches());
      if (!modes_->can_change()) continue;
      const std::vector<int> missed = modes_->adaptation().find_missed();
      if (missed.empty()) continue;
      for (const int coordinate : missed) {
        const ModeShare share = modes_->adaptation().share_of(coordinate);
        tell_mode(begin, coordinate,
                  fmt::format("joins: {:.3g} % of the deflection, {:.3g} % of the acceleration",
                              100.0 * share.deflection, 100.0 * share.acceleration));
      }
      modes_->join(*step_start_.memory, begin, missed);
      go_on_with_modes(begin, step_start_.flow);
      return false;
    }
    return true;
  }

  // Idle modes leave together where the rate of the slowest passes zero. No position jumps; the rates of the others, below
  // the drop threshold, are stopped with the momentum kept and the energy booked. @return true if some have left
  bool let_modes_go(double end) {
    const std::vector<int> idle = modes_->adaptation().find_idle();
    if (idle.empty()) return false;
    const auto slowest = std::min_element(idle.begin(), idle.end(), [this](int a, int b) {
      return modes_->adaptation().frequency_of(a) < modes_->adaptation().frequency_of(b);
    });
    const std::optional<double> rest = find_rest(*slowest, step_start_.time, end);
    if (!rest) return false;
    stepper_->evaluate(*rest);
    modes_->take(stepper_->equations());
    SystemStepper::EnergyFlow flow = total_flow();
    const double lost = modes_->leave(*rest, idle, piece().branches());
    flow.dissipated += lost;
    for (const int coordinate : idle) {
      tell_mode(*rest, coordinate,
                fmt::format("leaves: below {:.2g} %; energy lost by all that leave {:.1e} J",
                            100.0 * modes_->adaptation().options().drop, lost));
    }
    go_on_with_modes(*rest, flow);
    mark_step_start(*rest);
    return true;
  }

  // Where a modal rate is zero within the step just made.
  std::optional<double> find_rest(int coordinate, double begin, double end) {
    const auto rate = [&](double time) {
      stepper_->evaluate(time);
      modes_->take(stepper_->equations());
      return modes_->rate(coordinate);
    };
    double low = begin, high = end;
    const double rate_low = rate(begin);
    if (rate_low * rate(end) > 0.0) return std::nullopt;
    while (high - low > kSamePlace) {
      const double middle = 0.5 * (low + high);
      (rate(middle) * rate_low > 0.0 ? low : high) = middle;
    }
    return high;
  }

  void go_on_with_modes(double time, const SystemStepper::EnergyFlow& flow) {
    const std::vector<int> branches = piece().branches();
    count_work();
    count_modes(time);
    ++statistics_.mode_changes;
    flow_before_ = flow;
    take_stepper(modes_->stepped_state(time, branches));
    stepper_->resume(smooth_end_);
  }

  void tell_mode(double time, int coordinate, const std::string& what) const {
    tell({time, "modes", modes_->adaptation().options().full->coordinate_name(coordinate), what});
  }

  void count_modes(double time) {
    statistics_.mean_active_modes += num_active_modes_ * (time - mean_since_);
    mean_since_ = time;
    num_active_modes_ = modes_->adaptation().num_active_modes();
  }

  void finish_modes() {
    statistics_.worst_neglect = modes_->adaptation().worst();
    count_modes(stepper_->time());
    if (mean_since_ > start_time_) statistics_.mean_active_modes /= mean_since_ - start_time_;
  }

  const Model& model_;  // the full one where modes change
  const TransientOptions& options_;
  std::optional<ModeChanges> modes_;
  std::unique_ptr<SystemStepper> stepper_;
  SystemStepper::EnergyFlow flow_before_;  // of the steppers before
  StepStart step_start_;
  double mean_since_ = 0.0;
  int num_active_modes_ = 0;
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
