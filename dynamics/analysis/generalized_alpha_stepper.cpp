#include "dynamics/analysis/generalized_alpha_stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kFirstLength = 1e-4;       // s; too long a step is found out
constexpr double kShortestStep = 1e-10;     // s
constexpr double kSwitchTolerance = 1e-12;  // s
constexpr double kProbe = 1e-5;             // of a step, for rates at a start

constexpr int kMaxIterations = 8;
constexpr double kIterationShare = 0.05;   // error of the iteration, of what is allowed
constexpr double kNothingLeft = 1e-3;      // of what is allowed
constexpr double kSlowContraction = 0.15;  // beyond it another matrix is cheaper than the iterations
constexpr double kUselessContraction = 0.7;
constexpr double kRounding =
    64.0 * std::numeric_limits<double>::epsilon();  // of a coordinate and its natural size

constexpr double kSafety = 0.85, kOrder = 3.0, kLeastFactor = 0.2, kLargestFactor = 2.0;
// A step is kept as it is where a better one would hardly be longer: equal steps make the smoother
// multipliers.
constexpr double kWorthwhile = 1.2;

[[noreturn]] void throw_stopped(double time, const char* reason) {
  throw support::NumericalError(fmt::format("integration stopped at t = {:.9g} s: {}", time, reason));
}

}  // namespace

GeneralizedAlphaStepper::Node::Node(const Model& model, int num_switches)
    : motion(model),
      lead(motion.q),
      jerk(motion.q),
      lambda_rate(motion.lambda),
      energy(Pair::Zero()),
      power(Pair::Zero()),
      power_rate(Pair::Zero()),
      switches(Vector::Zero(num_switches)) {}

GeneralizedAlphaStepper::GeneralizedAlphaStepper(const Model& model, const Integrator::Options& options)
    : model_(&model),
      method_(options.spectral_radius),
      tolerance_(options.relative_tolerance),
      fixed_step_(options.fixed_step),
      scales_(model),
      piece_(model),
      equations_(model, SystemTerms::Markers::kActing),
      residual_(model),
      newton_(model),
      begin_(model, piece_.num_switches()),
      end_(begin_),
      next_length_(kFirstLength),
      switch_search_(piece_.num_switches()) {
  auxiliary_begin_ = auxiliary_end_ = delta_ = q_ = v_ = probe_ = begin_.motion.q;
  delta_lambda_ = scaled_phi_ = begin_.motion.lambda;
}

void GeneralizedAlphaStepper::start(const State& state) {
  begin_ = Node(*model_, piece_.num_switches());
  begin_.motion.time = time_ = state.time;
  begin_.motion.q = state.q;
  begin_.motion.v = state.v;
  piece_.set_branches(state.branches);
  has_step_ = false;
}

// The equations at a motion that need not satisfy the constraints of the velocities.
void GeneralizedAlphaStepper::evaluate_equations(const ConstrainedMotion& motion) {
  ++num_evaluations_;
  SystemTerms& terms = equations_.terms();
  terms.update_positions(motion.time, motion.q);
  terms.update_jacobian();
  terms.update_velocities(motion.v);
  if (!equations_.update_accelerations(piece_.branches())) {
    throw_stopped(time_, "no accelerations can be found there");
  }
}

// Dissipated, and put in, where the equations are.
GeneralizedAlphaStepper::Pair GeneralizedAlphaStepper::calc_power() {
  const Power& power = equations_.terms().power();
  return {power.dissipated, power.input + equations_.calc_motion_power()};
}

// Prescribed motion works with the multipliers that belong to the motion: those of the step jump where its
// length does.
void GeneralizedAlphaStepper::update_end_power() {
  if (model_->has_motions) {
    evaluate_equations(end_.motion);
    end_.power = calc_power();
    return;
  }
  // The residual is of the motion before the last change, by much less than the tolerance.
  const Power& power = residual_.terms().power();
  end_.power = {power.dissipated, power.input};
}

void GeneralizedAlphaStepper::resume(double end_time) {
  if (statistics_.integrator.steps > 0) ++statistics_.integrator.restarts;
  end_time_ = end_time;
  time_ = evaluated_time_;
  if (!equations_.update_accelerations(piece_.branches())) {
    throw_stopped(time_, "no accelerations can be found there");
  }
  ConstrainedMotion& motion = begin_.motion;
  motion.time = time_;
  motion.q = equations_.q();
  motion.v = equations_.v();
  motion.v_dot = equations_.v_dot();
  motion.lambda = equations_.multipliers();
  begin_.energy = evaluated_energy_;
  begin_.step_before = 0.0;
  has_step_ = false;
  if (end_time_ - time_ > kShortestStep) find_rates();
  residual_.update(motion, piece_.branches());
  piece_.calc_switches(residual_.terms(),
                       {begin_.switches.data(), static_cast<std::size_t>(begin_.switches.size())});
}

// The auxiliary acceleration leads q̈ by αm − αf of a step: to second order that takes the rate of q̈ (eq. 61).
// It is found from the accelerations a little later.
void GeneralizedAlphaStepper::find_rates() {
  const ConstrainedMotion& motion = begin_.motion;
  begin_.power = calc_power();
  const double shift = kProbe * std::min(next_length_, end_time_ - time_);
  end_.motion = motion;
  end_.motion.time = motion.time + shift;
  end_.motion.q += shift * motion.v + 0.5 * shift * shift * motion.v_dot;
  end_.motion.v += shift * motion.v_dot;
  evaluate_equations(end_.motion);
  begin_.jerk = (equations_.v_dot() - motion.v_dot) / shift;
  begin_.lambda_rate = (equations_.multipliers() - motion.lambda) / shift;
  begin_.lead = method_.offset() * begin_.jerk;
  begin_.power_rate = (calc_power() - begin_.power) / shift;
}

double GeneralizedAlphaStepper::choose_length(double longest_step) const {
  const double left = end_time_ - time_;
  const double length = std::min(fixed_step_ > 0.0 ? fixed_step_ : next_length_, longest_step);
  if (fixed_step_ > 0.0) return left / std::ceil(left / length - 1e-6);
  if (length >= left * (1.0 - 1e-9)) return left;
  return 2.0 * length > left ? 0.5 * left : length;
}

Index3Newton::Weights GeneralizedAlphaStepper::weights(double length) const {
  return {.acceleration = (1.0 - method_.alpha_m) / (1.0 - method_.alpha_f),
          .velocity = method_.gamma * length,
          .position = method_.beta * length * length};
}

void GeneralizedAlphaStepper::predict(double length) {
  const ConstrainedMotion& from = begin_.motion;
  auxiliary_begin_ = from.v_dot + length * begin_.lead;
  auxiliary_end_ = auxiliary_begin_ + length * begin_.jerk;
  end_.motion.lambda = from.lambda + length * begin_.lambda_rate;
  end_.motion.time = piece_.evaluation_time(from.time + length);
  apply_auxiliary(length);
}

// q, v and v̇ at the end by the auxiliary accelerations (eqs. 58 and 59).
void GeneralizedAlphaStepper::apply_auxiliary(double length) {
  const ConstrainedMotion& from = begin_.motion;
  ConstrainedMotion& to = end_.motion;
  to.q = from.q + length * from.v +
         length * length * ((0.5 - method_.beta) * auxiliary_begin_ + method_.beta * auxiliary_end_);
  to.v = from.v + length * ((1.0 - method_.gamma) * auxiliary_begin_ + method_.gamma * auxiliary_end_);
  to.v_dot = ((1.0 - method_.alpha_m) * auxiliary_end_ + method_.alpha_m * auxiliary_begin_ -
              method_.alpha_f * from.v_dot) /
             (1.0 - method_.alpha_f);
}

void GeneralizedAlphaStepper::renew_matrix(const Index3Newton::Weights& weights) {
  if (renewal_ == Renewal::kAll) newton_.linearise(residual_, end_.motion, piece_.branches());
  newton_.factorise(residual_.terms(), weights);  // a singular one gives infinities
  renewal_ = Renewal::kNone;
  is_fresh_ = true;
}

// What an error may be; not below what rounding of positions does, which over a short step is much in
// velocities.
double GeneralizedAlphaStepper::allowed_position(int i) const {
  return std::max(tolerance_ * scales_.position(i), rounding(i));
}

double GeneralizedAlphaStepper::allowed_velocity(int i, double length) const {
  return std::max(tolerance_ * scales_.velocity(i, begin_.motion.v[i]),
                  rounding(i) * method_.gamma / (method_.beta * length));
}

double GeneralizedAlphaStepper::rounding(int i) const {
  return kRounding * (model_->coordinate_scale(i) + std::abs(begin_.motion.q[i]));
}

// Root mean square of what the iteration has changed in q and v, of what is allowed.
double GeneralizedAlphaStepper::calc_iteration_norm(double length) const {
  const Index3Newton::Weights change = weights(length);
  double sum = 0.0;
  for (int i = 0; i < model_->num_coordinates; ++i) {
    sum += std::pow(change.position * delta_[i] / allowed_position(i), 2) +
           std::pow(change.velocity * delta_[i] / allowed_velocity(i, length), 2);
  }
  return std::sqrt(sum / (2.0 * model_->num_coordinates));
}

bool GeneralizedAlphaStepper::iterate(double length) {
  const Index3Newton::Weights step_weights = weights(length);
  predict(length);
  contraction_ = 0.0;
  double last = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    residual_.update(end_.motion, piece_.branches());
    if (renewal_ != Renewal::kNone) renew_matrix(step_weights);
    scaled_phi_ = residual_.phi() / step_weights.position;
    newton_.solve(residual_.force(), scaled_phi_, delta_, delta_lambda_);
    auxiliary_end_ += delta_;
    end_.motion.lambda += delta_lambda_;
    apply_auxiliary(length);
    const double norm = calc_iteration_norm(length);
    if (!std::isfinite(norm)) return false;
    if (norm <= kNothingLeft) return true;
    if (iteration > 0) {
      contraction_ = norm / last;
      if (contraction_ >= kUselessContraction) return norm <= kIterationShare;
      if (norm <= 1.0 && norm * contraction_ / (1.0 - contraction_) <= kIterationShare) return true;
    }
    last = norm;
  }
  return false;
}

// Newton's iteration, once more with a matrix of this very step where the one at hand does not do.
bool GeneralizedAlphaStepper::converge(double length) {
  is_fresh_ = false;
  if (!iterate(length)) {
    ++statistics_.integrator.iteration_failures;
    if (is_fresh_) return false;
    renewal_ = Renewal::kAll;
    if (!iterate(length)) {
      renewal_ = Renewal::kAll;
      return false;
    }
  }
  // Positions and masses change the matrix first; where they are new and it is slow still, it is the forces.
  if (contraction_ > kSlowContraction) renewal_ = is_fresh_ ? Renewal::kAll : Renewal::kFactors;
  return true;
}

// e ← the part of an error in the coordinates that counts, by Newton's matrix: without what the constraints
// take away again, that is M⁻¹φ_qᵀ times anything, and without what stiff modes damp.
void GeneralizedAlphaStepper::filter_error(Vector& error) {
  scaled_phi_.setZero();
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const int first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    probe_.segment(first, size).noalias() = residual_.terms().mass(b) * error.segment(first, size);
  }
  probe_ *= -(1.0 - method_.alpha_m) / (1.0 - method_.alpha_f);
  newton_.solve(probe_, scaled_phi_, error, delta_lambda_);
}

// Root mean square over q, v and the energies of what the step has made wrong, of what is allowed (eq. 62).
double GeneralizedAlphaStepper::calc_error(double length) {
  const double between = 0.5 * (length + begin_.step_before);  // of the middles of this step and the last
  const double cubed = std::pow(length, 3);
  q_ = auxiliary_end_ - auxiliary_begin_;
  v_ = (method_.velocity_error() * cubed / between) * (q_ / length - begin_.jerk);
  q_ *= method_.position_error() * length * length;
  filter_error(q_);
  filter_error(v_);
  double sum = 0.0;
  for (int i = 0; i < model_->num_coordinates; ++i) {
    sum += std::pow(q_[i] / allowed_position(i), 2) + std::pow(v_[i] / allowed_velocity(i, length), 2);
  }
  const Pair curvature = ((end_.power - begin_.power) / length - begin_.power_rate) / between;
  sum += (cubed / 12.0 * curvature / (tolerance_ * scales_.energy())).squaredNorm();
  return std::sqrt(sum / (2.0 * model_->num_coordinates + 2.0));
}

Integrator::StepResult GeneralizedAlphaStepper::step(double longest_step) {
  if (end_time_ - time_ <= kShortestStep) {
    time_ = end_time_;
    return Integrator::StepResult::kEnded;
  }
  if (has_step_) std::swap(begin_, end_);
  has_step_ = false;
  double length, factor = 1.0;
  while (true) {
    length = choose_length(longest_step);
    if (length < kShortestStep) {
      throw_stopped(
          time_,
          "the step has become too short; look at forces and positions just before that time, which may be "
          "a singular one");
    }
    if (!converge(length)) {
      if (fixed_step_ > 0.0)
        throw_stopped(time_, "the iteration of a step does not converge; shorten fixed_step");
      next_length_ = 0.25 * length;
      continue;
    }
    update_end_power();
    if (fixed_step_ > 0.0) break;
    const double error = calc_error(length);
    factor =
        std::clamp(kSafety * std::pow(std::max(error, 1e-10), -1.0 / kOrder), kLeastFactor, kLargestFactor);
    if (error <= 1.0) break;
    ++statistics_.integrator.error_test_failures;
    next_length_ = std::min(factor, 0.9) * length;
    if (renewal_ == Renewal::kNone) renewal_ = Renewal::kFactors;
  }
  if (factor < 1.0 / kWorthwhile) next_length_ = factor * length;
  if (factor > kWorthwhile) next_length_ = std::max(next_length_, factor * length);
  finish_step(length);
  if (piece_.num_switches() > 0 && locate_switch()) return Integrator::StepResult::kSwitched;
  return time_ >= end_time_ ? Integrator::StepResult::kEnded : Integrator::StepResult::kStepped;
}

void GeneralizedAlphaStepper::finish_step(double length) {
  ++statistics_.integrator.steps;
  time_ = end_time_ - begin_.motion.time <= length * (1.0 + 1e-12) ? end_time_ : begin_.motion.time + length;
  end_.motion.time = time_;
  end_.step_before = length;
  end_.lead = (auxiliary_end_ - end_.motion.v_dot) / length;
  end_.jerk = (auxiliary_end_ - auxiliary_begin_) / length;
  end_.lambda_rate = (end_.motion.lambda - begin_.motion.lambda) / length;
  end_.power_rate = (end_.power - begin_.power) / length;
  end_.energy = begin_.energy + 0.5 * length * (begin_.power + end_.power);
  has_step_ = true;
}

// Cubic through positions and velocities, velocities and accelerations, energies and powers of both ends.
void GeneralizedAlphaStepper::interpolate(double time) {
  const ConstrainedMotion &a = begin_.motion, &b = end_.motion;
  const double length = b.time - a.time, s = (time - a.time) / length;
  const double of_b = s * s * (3.0 - 2.0 * s), of_a = 1.0 - of_b;
  const double rate_of_a = length * s * (1.0 - s) * (1.0 - s), rate_of_b = -length * s * s * (1.0 - s);
  q_ = of_a * a.q + of_b * b.q + rate_of_a * a.v + rate_of_b * b.v;
  v_ = of_a * a.v + of_b * b.v + rate_of_a * a.v_dot + rate_of_b * b.v_dot;
  evaluated_energy_ =
      of_a * begin_.energy + of_b * end_.energy + rate_of_a * begin_.power + rate_of_b * end_.power;
}

bool GeneralizedAlphaStepper::locate_switch() {
  const auto span_of = [](Vector& x) { return std::span(x.data(), static_cast<std::size_t>(x.size())); };
  piece_.calc_switches(residual_.terms(), span_of(end_.switches));
  if (!SwitchSearch::any_crosses(begin_.switches, end_.switches)) return false;
  const double from = begin_.motion.time, length = end_.motion.time - from;
  const double tolerance = std::max(kSwitchTolerance, 4e-16 * std::abs(time_)) / length;
  const double theta = switch_search_.locate(
      0.0, 1.0, tolerance, begin_.switches, end_.switches, [&](double place, Vector& values) {
        interpolate(from + place * length);
        residual_.terms().update_positions(piece_.evaluation_time(from + place * length), q_);
        residual_.terms().update_velocities(v_);
        piece_.calc_switches(residual_.terms(), span_of(values));
      });
  time_ = from + theta * length;
  return true;
}

void GeneralizedAlphaStepper::evaluate(double time) {
  if (has_step_) {
    interpolate(time);
  } else {
    q_ = begin_.motion.q;
    v_ = begin_.motion.v;
    evaluated_energy_ = begin_.energy;
  }
  evaluated_time_ = time;
  const bool is_closed = equations_.close_joints(piece_.evaluation_time(time), q_);
  const double violation = is_closed ? equations_.close_rates(v_) : std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(violation) || !equations_.update_accelerations(piece_.branches())) {
    throw support::NumericalError(fmt::format(
        "the joints cannot be closed at t = {:.9g} s: a singular position; try a smaller step", time));
  }
  statistics_.velocity_violation = std::max(statistics_.velocity_violation, violation);
  equations_.terms().update_all_markers();
}

SystemStepper::Statistics GeneralizedAlphaStepper::statistics() const {
  Statistics statistics = statistics_;
  statistics.evaluations = residual_.num_updates() + num_evaluations_;
  return statistics;
}

}  // namespace sprung::dynamics
