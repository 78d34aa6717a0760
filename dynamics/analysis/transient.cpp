#include "dynamics/analysis/transient.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kPartitionDecay = 3.0;    // partition_decay() at which another one is chosen
constexpr int kMaxSwitchesInPlace = 100;   // switches within kSamePlace of each other before the run is given up
constexpr double kSamePlace = 1e-9;        // s
constexpr double kPeriodsOfRelease = 4.0;  // over which what was held is let go
constexpr double kLongestUnseen = 2e-3;    // s between updates of the indicator of modes

class TransientRun {
 public:
  TransientRun(const Model& model, const TransientOptions& options) : model_(model), options_(options) {}

  TransientStatistics run(const State& start) {
    start_time_ = mean_since_ = start.time;
    take_model(start);
    if (modes_) last_num_modes_ = modes_->num_active_modes();
    ode_->update_branches();
    y_.assign(ode_->y().begin(), ode_->y().end());
    if (modes_) update_modes(start.time);
    write_outputs(start.time, ode_->y());
    if (start.time < options_.end_time) {
      integrator_->start(start.time, ode_->y(), smooth_end_);
      integrate();
    }
    count_work();
    if (modes_) statistics_.worst_neglect = modes_->worst();
    count_modes(integrator_->time());
    if (mean_since_ > start_time_) statistics_.mean_active_modes /= mean_since_ - start_time_;
    return statistics_;
  }

 private:
  void take_model(const State& start) {
    State state = start;
    if (options_.adaptivity) {
      const AdaptivityOptions& adaptivity = *options_.adaptivity;
      if (adaptivity.changes) {
        modes_.emplace(adaptivity, start);
        held_ = hold_modes(model_, modes_->active(), start.q);
        state.q = select_active(held_, start.q);
        state.v = select_active(held_, start.v);
      } else {
        // The run's model is fixed; in the full one the modes that it lacks stand at zero.
        held_ = match_modes(model_, *adaptivity.full);
        State full{.time = start.time, .q = Eigen::VectorXd::Zero(adaptivity.full->num_coordinates), .v = {}, .branches = {}};
        put_active(held_, start.q, full.q);
        modes_.emplace(adaptivity, full);
      }
      full_q_ = full_v_ = full_v_dot_ = Eigen::VectorXd::Zero(adaptivity.full->num_coordinates);
      if (adaptivity.changes) {
        full_q_ = start.q;
        full_terms_.emplace(model_);
      }
    }
    ode_ = std::make_unique<PartitionedOde>(has_changes() ? held_.model : model_);
    integrator_ = make_integrator(*ode_, options_.integrator);
    find_end_of_smoothness(start.time);
    ode_->set_state(state, 0.0, 0.0);
    ode_->make_state(start.time, ode_->y());
  }

  bool has_changes() const { return modes_ && modes_->options().changes; }

  void integrate() {
    while (true) {
      const double longest = std::min(options_.largest_step, ode_->calc_longest_step());
      const StepStart before = remember();
      const Integrator::StepResult result = take_step(longest);
      if (modes_ && !follow_modes(before)) continue;
      write_outputs(integrator_->time(), {});
      if (options_.on_step && !options_.on_step(integrator_->time())) return;
      if (has_changes() && result != Integrator::StepResult::kSwitched && let_modes_go(before)) continue;
      if (result == Integrator::StepResult::kEnded) {
        if (smooth_end_ >= options_.end_time) break;
        take_break();
      } else if (result == Integrator::StepResult::kSwitched) {
        take_switch();
      } else if (ode_->equations().partition_decay() > kPartitionDecay) {
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
    double next = ode_->update_next_break(time);
    while (next - time < kSamePlace) next = ode_->update_next_break(next);  // too short to be integrated
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
    ode_->make_state(time, y_);
    for (const BranchChange& change : ode_->update_branches()) {
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
    const State state = ode_->make_state(time, y_);
    ode_->set_state(state, ode_->dissipated(y_), ode_->input(y_));
    ++statistics_.repartitions;
    if (options_.on_event) options_.on_event({time, "partition", "", "independent coordinates chosen anew"});
    integrator_->start(time, ode_->y(), smooth_end_);
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
    ode_->make_state(time, y_);
    ++statistics_.output_evaluations;
    if (!options_.on_output) return;
    const bool changes = has_changes();
    if (changes) {
      update_full();
      full_terms_->update_positions(time, full_q_);
      full_terms_->update_jacobian();
      full_terms_->update_mass();
      full_terms_->update_velocities(full_v_);
    } else {
      ode_->equations().update_all_markers();
    }
    const PartitionedEquations& equations = ode_->equations();
    const SystemTerms& terms = changes ? *full_terms_ : equations.terms();
    options_.on_output({.time = time,
                        .terms = terms,
                        .q = changes ? full_q_ : equations.q(),
                        .v = changes ? full_v_ : equations.v(),
                        .v_dot = changes ? full_v_dot_ : equations.v_dot(),
                        .multipliers = equations.multipliers(),
                        .branches = ode_->branches(),
                        .energy = {calc_energy(terms, ode_->branches()), ode_->dissipated(y_), ode_->input(y_)},
                        .modes = modes_ ? &*modes_ : nullptr});
  }

  // ---- modes that join and leave

  struct StepStart {
    double time = 0.0;
    std::vector<double> y;
    std::shared_ptr<const ModeAdaptation::Memory> memory;
  };

  StepStart remember() const {
    if (!modes_) return {};
    StepStart start{.time = integrator_->time(), .y = {}, .memory = nullptr};
    if (has_changes()) {
      start.y.assign(integrator_->y().begin(), integrator_->y().end());
      start.memory = modes_->remember();
    }
    return start;
  }

  // Positions, velocities and accelerations evaluated last, in coordinates of the full model.
  void update_full() {
    const PartitionedEquations& equations = ode_->equations();
    put_active(held_, equations.q(), full_q_);
    put_active(held_, equations.v(), full_v_);
    put_active(held_, equations.v_dot(), full_v_dot_);
  }

  void update_modes(double time) {
    ode_->make_state(time, y_);
    update_full();
    modes_->update(time, full_q_, full_v_, full_v_dot_, ode_->equations().multipliers(), ode_->branches());
  }

  // Brings the indicator to the end of the step just made. @return false if a mode was missed in it: then the step was
  // taken back, and the run goes on from its start with that mode
  bool follow_modes(const StepStart& before) {
    const double end = integrator_->time(), length = end - before.time;
    if (!(length > 0.0)) return true;
    const int parts = static_cast<int>(std::clamp(std::ceil(length / kLongestUnseen), 1.0, 8.0));
    for (int i = 1; i <= parts; ++i) {
      const double time = i == parts ? end : before.time + length * i / parts;
      integrator_->interpolate(time, y_);
      update_modes(time);
      if (!has_changes()) continue;
      const std::vector<int> missed = modes_->find_missed();
      if (missed.empty()) continue;
      for (const int coordinate : missed) {
        const ModeShare share = modes_->share_of(coordinate);
        tell(before.time, coordinate,
             fmt::format("joins: {:.2g} % of the deflection, {:.2g} % of the acceleration", 100.0 * share.deflection,
                         100.0 * share.acceleration));
      }
      modes_->go_back(*before.memory);
      y_ = before.y;
      ode_->make_state(before.time, y_);
      update_full();
      for (const int coordinate : missed) {
        // What was held is let go slowly, or it would ring.
        fading_.push_back({coordinate, -modes_->unbalanced_force_of(coordinate), before.time,
                           kPeriodsOfRelease / modes_->frequency_of(coordinate)});
      }
      modes_->activate(missed);
      go_on_with_modes(before.time);
      return false;
    }
    return true;
  }

  // Idle modes leave together where the rate of the slowest passes zero. No position jumps; the rates of the others, below
  // the drop threshold, are stopped with the momentum kept and the energy booked. @return true if some have left
  bool let_modes_go(const StepStart& before) {
    const std::vector<int> idle = modes_->find_idle();
    double first = std::numeric_limits<double>::infinity();
    double slowest = std::numeric_limits<double>::infinity();  // it has the most to lose
    for (const int coordinate : idle) {
      const double frequency = modes_->frequency_of(coordinate);
      if (frequency >= slowest) continue;
      slowest = frequency;
      first = find_rest(coordinate, before.time, integrator_->time());
    }
    if (!std::isfinite(first)) return false;
    integrator_->interpolate(first, y_);
    ode_->make_state(first, y_);
    update_full();
    const double energy = full_energy(first);
    const Eigen::VectorXd momentum = full_momentum();
    modes_->deactivate(idle);
    go_on_with_modes(first);
    keep_momentum(momentum);
    ode_->make_state(first, y_);
    update_full();
    const double lost = energy - full_energy(first);
    y_[y_.size() - 2] += lost;
    integrator_->start(first, y_, smooth_end_);
    for (const int coordinate : idle) {
      tell(first, coordinate, fmt::format("leaves: below {:.2g} %; energy lost by all that leave {:.1e} J",
                                          100.0 * modes_->options().drop, lost));
    }
    return true;
  }

  // M v of the full model, after full_energy.
  Eigen::VectorXd full_momentum() const {
    Eigen::VectorXd momentum(model_.num_coordinates);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const Body& body = model_.bodies[b];
      momentum.segment(body.first_coordinate, body.num_coordinates()) =
          full_terms_->mass(b) * full_v_.segment(body.first_coordinate, body.num_coordinates());
    }
    return momentum;
  }

  // The velocities in y_ become those after a sudden stop of the modes that have left, as by an impulse on them alone:
  // Dᵀ(M v − momentum) = 0 in what goes on.
  void keep_momentum(const Eigen::VectorXd& momentum) {
    const PartitionedEquations& equations = ode_->equations();
    const Eigen::MatrixXd directions = equations.calc_directions();
    Eigen::VectorXd missing = select_active(held_, momentum);
    for (std::size_t b = 0; b < held_.model.bodies.size(); ++b) {
      const Body& body = held_.model.bodies[b];
      missing.segment(body.first_coordinate, body.num_coordinates()) -=
          equations.terms().mass(b) * equations.v().segment(body.first_coordinate, body.num_coordinates());
    }
    const Eigen::VectorXd change =
        equations.calc_reduced_mass(directions).llt().solve(directions.transpose() * missing);
    for (Eigen::Index k = 0; k < change.size(); ++k) y_[static_cast<std::size_t>(change.size() + k)] += change[k];
  }

  // Where a modal rate is zero within the step just made, infinite if it is not.
  double find_rest(int coordinate, double begin, double end) {
    const auto rate = [&](double time) {
      integrator_->interpolate(time, y_);
      ode_->make_state(time, y_);
      update_full();
      return full_v_[coordinate];
    };
    double low = begin, high = end;
    const double rate_low = rate(begin);
    if (rate_low * rate(end) > 0.0) return std::numeric_limits<double>::infinity();
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      (rate(middle) * rate_low > 0.0 ? low : high) = middle;
    }
    return high;
  }

  double full_energy(double time) {
    full_terms_->update_positions(time, full_q_);
    full_terms_->update_mass();
    full_terms_->update_velocities(full_v_);
    return calc_energy(*full_terms_, ode_->branches()).total();
  }

  void tell(double time, int coordinate, const std::string& what) {
    const Model& full = *modes_->options().full;
    if (options_.on_event) options_.on_event({time, "modes", full.coordinate_name(coordinate), what});
  }

  // From full_q_ and full_v_ on, with the modes that are active now; y_ still has the energies.
  void go_on_with_modes(double time) {
    count_work();
    count_modes(time);
    ++statistics_.mode_changes;
    State state{.time = time, .q = {}, .v = {}, .branches = ode_->branches()};
    const double dissipated = ode_->dissipated(y_), input = ode_->input(y_);
    held_ = hold_modes(model_, modes_->active(), full_q_);
    carry_fading_forces(time);
    state.q = select_active(held_, full_q_);
    state.v = select_active(held_, full_v_);
    full_v_.setZero();
    full_v_dot_.setZero();
    ode_ = std::make_unique<PartitionedOde>(held_.model);
    integrator_ = make_integrator(*ode_, options_.integrator);
    find_end_of_smoothness(time);
    ode_->set_state(state, dissipated, input);
    ode_->make_state(time, ode_->y());
    y_.assign(ode_->y().begin(), ode_->y().end());
    integrator_->start(time, ode_->y(), smooth_end_);
  }

  // The forces that still hold modes in part, for the model that goes on.
  void carry_fading_forces(double time) {
    std::erase_if(fading_, [&](const FadingForce& one) {
      return time >= one.start + one.duration || !modes_->active()[static_cast<std::size_t>(one.mode)];
    });
    for (FadingForce fading : fading_) {
      const auto place = std::lower_bound(held_.coordinates.begin(), held_.coordinates.end(), fading.mode);
      const int coordinate = static_cast<int>(place - held_.coordinates.begin());
      for (Body& body : held_.model.bodies) {
        if (coordinate >= body.first_coordinate + body.num_coordinates()) continue;
        fading.mode = coordinate - body.first_coordinate - 3;
        body.fading.push_back(fading);
        break;
      }
    }
  }

  // Adds the work of an integrator that is about to go.
  void count_work() {
    const Integrator::Statistics work = integrator_->statistics();
    statistics_.integrator.steps += work.steps;
    statistics_.integrator.error_test_failures += work.error_test_failures;
    statistics_.integrator.iteration_failures += work.iteration_failures;
    statistics_.integrator.restarts += work.restarts;
    statistics_.evaluations += ode_->num_derivatives();
  }

  void count_modes(double time) {
    if (!modes_) return;
    statistics_.mean_active_modes += last_num_modes_ * (time - mean_since_);
    mean_since_ = time;
    last_num_modes_ = modes_->num_active_modes();
  }

  const Model& model_;  // the full one where modes change
  const TransientOptions& options_;
  std::optional<ModeAdaptation> modes_;
  HeldModes held_;  // where modes_ are
  std::optional<SystemTerms> full_terms_;
  Eigen::VectorXd full_q_, full_v_, full_v_dot_;
  std::vector<FadingForce> fading_;  // `mode` is a coordinate of the full model
  double mean_since_ = 0.0;
  int last_num_modes_ = 0;
  std::unique_ptr<PartitionedOde> ode_;
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
