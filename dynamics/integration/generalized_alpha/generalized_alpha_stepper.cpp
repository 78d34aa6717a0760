#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dynamics/integration/attempt.h"
#include "dynamics/integration/throw_stopped.h"
#include "tools/support/dense/vector_span.h"

namespace sprung::dynamics {

namespace {

constexpr double kFirstLength = 1e-4;       // s; a step that is too long is repeated
constexpr double kShortestStep = 1e-10;     // s
constexpr double kSwitchTolerance = 1e-12;  // s
constexpr double kProbe = 1e-5;             // of a step, for rates at a start

constexpr int kSuspicious =
    5;  // failures of steps much longer than the last one, until a change point is suspected
constexpr double kSafety = 0.85, kOrder = 3.0, kLeastFactor = 0.2, kLargestFactor = 2.0;
constexpr int kMaxRemovals = 4;    // of vibration from accelerations that are put out
constexpr double kRemoved = 0.01;  // change of the accelerations by the last one
// The length of steps is kept where a better one would hardly be longer: equal steps give smoother
// multipliers.
constexpr double kWorthwhile = 1.2;

// Errors in the multipliers change their sign from step to step, and do not decay where the radius is 1.
const char* remark_on_radius(double spectral_radius) {
  return spectral_radius > 0.995 ? "; nothing damps the joints' forces at that spectral_radius: try 0.9" : "";
}

}  // namespace

GeneralizedAlphaStepper::GeneralizedAlphaStepper(const Model& model, double relative_tolerance,
                                                 const GeneralizedAlphaOptions& options)
    : model_(&model),
      method_(options.spectral_radius),
      spectral_radius_(options.spectral_radius),
      fixed_step_(options.fixed_step),
      piece_(model),
      equations_(model, SystemTerms::Markers::kActing),
      step_(model, piece_, method_, relative_tolerance),
      next_length_(kFirstLength),
      passage_(model),
      exact_(model, piece_.num_switches()),
      departure_(exact_),
      has_modes_(model.has_modes()),
      probe_(model),
      switches_(piece_.num_switches(), 2),
      switch_search_(piece_.num_switches()),
      touch_search_(piece_.num_switches()) {
  interpolated_q_ = interpolated_v_ = Vector::Zero(model.num_coordinates);
}

void GeneralizedAlphaStepper::start(const State& state) {
  step_.reset();
  step_.begin().motion.time = time_ = state.time;
  step_.begin().motion.q = state.q;
  step_.begin().motion.v = state.v;
  piece_.set_branches(state.branches);
  equations_.terms().set_fading_forces(state.fading);
  step_.residual().terms().set_fading_forces(state.fading);
  has_step_ = has_departure_ = false;
  passage_.start(equations_.terms(), step_.begin().motion);
}

// The equations at a motion that need not satisfy the constraints of the velocities.
bool GeneralizedAlphaStepper::evaluate_equations(const ConstrainedMotion& motion) {
  SystemTerms& terms = equations_.terms();
  terms.update_positions(motion.time, motion.q);
  terms.update_jacobian();
  terms.update_velocities(motion.v);
  return equations_.update_accelerations(piece_.branches());
}

// Dissipated power and power put in, where the equations stand.
GeneralizedAlphaStepper::Pair GeneralizedAlphaStepper::calc_power() {
  const Power& power = equations_.terms().power();
  return {power.dissipated, power.input + equations_.calc_motion_power()};
}

// The work of prescribed motion takes the multipliers that belong to the motion: those of the step jump where
// the step's length does.
bool GeneralizedAlphaStepper::update_end_power() {
  if (model_->has_moving_joints) {
    ++num_evaluations_;
    if (!evaluate_equations(step_.end().motion)) return false;
    step_.end().power = calc_power();
    return true;
  }
  // The residual is of the motion before the last change, by much less than the tolerance.
  const Power& power = step_.residual().terms().power();
  step_.end().power = {power.dissipated, power.input};
  return true;
}

void GeneralizedAlphaStepper::resume(double time, double end_time) {
  if (statistics_.integrator.steps > 0) ++statistics_.integrator.restarts;
  end_time_ = end_time;
  time_ = time;
  if (!equations_.update_accelerations(piece_.branches())) {
    throw_stopped(time_, "no accelerations can be found there");
  }
  const ConstrainedMotion& motion = step_.begin().motion;
  calc_exact(step_.begin(), kProbe * std::min(next_length_, end_time_ - time_));
  if (has_departure_) step_.depart(departure_);
  step_.begin().energy = energy_;
  step_.begin().step_before = 0.0;
  has_step_ = has_departure_ = false;
  step_.residual().update(motion, piece_.branches());
  piece_.calc_switches(step_.residual().terms(), {step_.begin().switches.data(),
                                                  static_cast<std::size_t>(step_.begin().switches.size())});
  // A formula that has just become valid may seem not to be so yet by a rounding error; the next change of
  // its switch function must not be missed.
  step_.begin().switches = step_.begin().switches.cwiseMax(0.0);
  touch_search_.forget();
}

// What the equations give where they stand. The auxiliary acceleration leads q̈ by αm − αf of a step. To
// second order this takes the rate of q̈ (integration/generalized_alpha, eq. 4), which is found from the
// accelerations a little later or before.
void GeneralizedAlphaStepper::calc_exact(GeneralizedAlphaStep::End& end, double shift) {
  ConstrainedMotion& motion = end.motion;
  motion.time = time_;
  motion.q = equations_.q();
  motion.v = equations_.v();
  motion.v_dot = equations_.v_dot();
  motion.lambda = equations_.multipliers();
  end.power = calc_power();
  if (std::abs(shift) < kProbe * kShortestStep) return;
  probe_.time = piece_.evaluation_time(motion.time + shift);
  probe_.q = motion.q + (shift * motion.v + 0.5 * shift * shift * motion.v_dot);
  probe_.v = motion.v + shift * motion.v_dot;
  ++num_evaluations_;
  if (!evaluate_equations(probe_)) throw_stopped(time_, "no accelerations can be found there");
  end.jerk = (equations_.v_dot() - motion.v_dot) / shift;
  end.lambda_rate = (equations_.multipliers() - motion.lambda) / shift;
  end.lead = method_.offset() * end.jerk;
  end.power_rate = (calc_power() - end.power) / shift;
}

// Accelerations of stiff modes, which a step does not resolve, differ from those of the equations by the
// error of a position times stiffness over mass. A restart from the latter would make a vibration of that
// error. So what jumps from one piece to the next is added to the accelerations of the method.
void GeneralizedAlphaStepper::leave_piece(bool at_switch) {
  // Positions at a switch have to be those at which it was located.
  if (!evaluate_within_step(time_) || !(at_switch || remove_vibration(time_))) throw_open_joints(time_);
  calc_exact(exact_, -kProbe * next_length_);
  step_.calc_departure(exact_, departure_);
  has_departure_ = true;
}

double GeneralizedAlphaStepper::choose_length(double longest_step) const {
  const double left = end_time_ - time_;
  const double length = std::min(fixed_step_ > 0.0 ? fixed_step_ : next_length_, longest_step);
  if (fixed_step_ > 0.0) return left / std::ceil(left / length - 1e-6);
  if (length >= left * (1.0 - 1e-9)) return left;
  return 2.0 * length > left ? 0.5 * left : length;
}

Integrator::StepResult GeneralizedAlphaStepper::step(double longest_step) {
  has_departure_ = false;
  passage_.leave();
  if (end_time_ - time_ <= kShortestStep) {
    time_ = end_time_;
    return Integrator::StepResult::kEnded;
  }
  if (has_step_) step_.advance();
  has_step_ = false;
  bool has_pivot = passage_.pivot() < 1.0;
  if (has_pivot && pass_change_point_if_near(longest_step)) return end_passage();
  double length, factor = 1.0;
  int num_failures = 0;  // of the iteration, of steps much longer than the last one
  while (true) {
    length = choose_length(longest_step);
    if (length < kShortestStep) {
      if (pass_change_point(longest_step)) return end_passage();
      throw_stopped(time_, std::string("the step has become too short; look at forces and positions just "
                                       "before that time, which may be a singular one") +
                               remark_on_radius(spectral_radius_));
    }
    if (!step_.solve(length) || !update_end_power()) {
      const bool is_far = length > kLargestFactor * step_.begin().step_before;
      if (!has_pivot && (!is_far || fixed_step_ > 0.0 || ++num_failures == kSuspicious)) {
        has_pivot = true;
        if (pass_change_point_if_near(longest_step)) return end_passage();
        if (passage_.pivot() < 1.0) continue;
      }
      if (fixed_step_ > 0.0) {  // it may end too near to a change point
        if (passage_.pivot() < 1.0 && pass_change_point(longest_step)) return end_passage();
        throw_stopped(
            time_, std::string("the iteration of a step does not converge; shorten fixed_step, or leave it "
                               "out: a step of chosen length passes switches, and change points of a "
                               "mechanism") +
                       remark_on_radius(spectral_radius_));
      }
      next_length_ = 0.25 * length;
      continue;
    }
    if (fixed_step_ > 0.0) break;
    const double error = step_.calc_error(length);
    factor =
        std::clamp(kSafety * std::pow(std::max(error, 1e-10), -1.0 / kOrder), kLeastFactor, kLargestFactor);
    if (error <= 1.0) break;
    ++statistics_.integrator.error_test_failures;
    next_length_ = std::min(factor, 0.9) * length;
    step_.renew_factors();
  }
  if (factor < 1.0 / kWorthwhile) next_length_ = factor * length;
  if (factor > kWorthwhile) next_length_ = std::max(next_length_, factor * length);
  finish_step(length);
  const bool has_switched = piece_.num_switches() > 0 && locate_switch();
  if (!has_switched && time_ < end_time_) return Integrator::StepResult::kStepped;
  leave_piece(has_switched);
  return has_switched ? Integrator::StepResult::kSwitched : Integrator::StepResult::kEnded;
}

// Near a change point the rounding of positions is amplified, and the more in velocities, the shorter the
// step. So a shorter step does not help where rounding keeps the iteration from converging.
bool GeneralizedAlphaStepper::pass_change_point_if_near(double longest_step) {
  passage_.update_pivot(equations_.terms(), step_.begin().motion);
  step_.set_smallest_pivot(passage_.pivot());
  return passage_.is_near() && pass_change_point(longest_step);
}

bool GeneralizedAlphaStepper::pass_change_point(double longest_step) {
  const GeneralizedAlphaStep::End& from = step_.begin();
  if (!evaluate_closed(piece_.evaluation_time(time_), from.motion.q, from.motion.v)) return false;
  if (!passage_.pass(equations_, piece_.branches(), std::min(longest_step, end_time_ - time_), from.energy))
    return false;
  const double length = passage_.end().time - time_;
  time_ = passage_.end().time;
  evaluate_passage(time_);
  ++statistics_.integrator.steps;
  next_length_ = length;
  resume(time_, end_time_);
  return true;
}

Integrator::StepResult GeneralizedAlphaStepper::end_passage() const {
  return time_ < end_time_ ? Integrator::StepResult::kStepped : Integrator::StepResult::kEnded;
}

void GeneralizedAlphaStepper::evaluate_passage(double time) {
  energy_ = passage_.interpolate(time, inside_);
  equations_.set_motion(time, inside_.q, inside_.v, inside_.v_dot, inside_.lambda, piece_.branches());
}

void GeneralizedAlphaStepper::finish_step(double length) {
  ++statistics_.integrator.steps;
  const double from = step_.begin().motion.time;
  time_ = end_time_ - from <= length * (1.0 + 1e-12) ? end_time_ : from + length;
  step_.finish(length, time_);
  has_step_ = true;
}

bool GeneralizedAlphaStepper::locate_switch() {
  static constexpr std::array<double, 2> kEnds = {0.0, 1.0};
  SystemTerms& terms = step_.residual().terms();
  piece_.calc_switches(terms, support::as_span(step_.end().switches));
  const double from = step_.begin().motion.time, to = step_.end().motion.time, length = to - from;
  const double tolerance = std::max(kSwitchTolerance, 4e-16 * std::abs(time_)) / length;
  bool has_left = false;  // the end of the step
  const auto evaluate_at = [&](double place, Vector& values) {
    has_left = true;
    step_.interpolate_motion(from + place * length, interpolated_q_, interpolated_v_);
    terms.update_positions(piece_.evaluation_time(from + place * length), interpolated_q_);
    terms.update_velocities(interpolated_v_);
    piece_.calc_switches(terms, support::as_span(values));
  };
  const auto search = [&]() -> std::optional<double> {
    const Vector &begin = step_.begin().switches, &end = step_.end().switches;
    if (!SwitchSearch::any_crosses(begin, end))
      return touch_search_.find(begin, end, length, tolerance, evaluate_at);
    switches_.col(0) = begin;
    switches_.col(1) = end;
    return switch_search_.locate(kEnds, switches_, 1, tolerance, evaluate_at);
  };
  const auto go_back = [&] {
    if (!has_left) return;
    terms.update_positions(piece_.evaluation_time(to), step_.end().motion.q);
    terms.update_velocities(step_.end().motion.v);
  };
  const std::optional<double> theta = attempt_or_go_back(search, go_back);
  if (theta) time_ = from + *theta * length;
  return theta.has_value();
}

// Accelerations are evaluated always: without them a singular position would not be noticed.
bool GeneralizedAlphaStepper::evaluate_closed(double time, const Vector& q, const Vector& v) {
  if (!equations_.close_joints(time, q)) return false;
  const double violation = equations_.close_rates(v);
  statistics_.velocity_violation = std::max(statistics_.velocity_violation, violation);
  return std::isfinite(violation) && equations_.update_accelerations(piece_.branches());
}

bool GeneralizedAlphaStepper::evaluate_within_step(double time) {
  step_.interpolate_motion(time, probe_.q, probe_.v);
  energy_ = step_.interpolate_energy(time);
  probe_.time = piece_.evaluation_time(time);
  return evaluate_closed(probe_.time, probe_.q, probe_.v);
}

// After evaluate_within_step. Closing the joints moves stiff modes by a part of the violation, and stiffness
// over mass makes accelerations of that. A few passes remove them, also where Newton's matrix is of a
// position some way off.
bool GeneralizedAlphaStepper::remove_vibration(double time) {
  if (!has_modes_) return true;
  probe_.q = equations_.q();
  probe_.v = equations_.v();
  for (int pass = 0; pass < kMaxRemovals; ++pass) {
    probe_.v_dot = equations_.v_dot();
    equations_.terms().calc_residual(probe_.lambda);
    step_.remove_vibration(time, probe_.v_dot, probe_.lambda, probe_.q);
    if (!probe_.q.allFinite() || !evaluate_equations(probe_)) return false;
    if ((equations_.v_dot() - probe_.v_dot).norm() <= kRemoved * probe_.v_dot.norm()) break;
  }
  return true;
}

void GeneralizedAlphaStepper::evaluate(double time, Level level) {
  bool is_evaluated = true;
  if (passage_.contains(time)) {
    evaluate_passage(time);
  } else if (has_departure_ && time == time_) {  // the branches may be others than in the step
    energy_ = step_.interpolate_energy(time);
    is_evaluated = evaluate_equations(exact_.motion);
  } else if (has_step_) {
    is_evaluated = evaluate_within_step(time) && remove_vibration(time);
  } else {
    const ConstrainedMotion& motion = step_.begin().motion;
    energy_ = step_.begin().energy;
    is_evaluated = evaluate_closed(piece_.evaluation_time(time), motion.q, motion.v);
  }
  if (!is_evaluated) throw_open_joints(time);
  if (level == Level::kAllMarkers) equations_.terms().update_all_markers();
}

SystemStepper::Statistics GeneralizedAlphaStepper::statistics() const {
  Statistics statistics = statistics_;
  statistics.integrator.iteration_failures = step_.iteration_failures();
  statistics.evaluations = step_.residual().num_updates() + num_evaluations_;
  return statistics;
}

}  // namespace sprung::dynamics
