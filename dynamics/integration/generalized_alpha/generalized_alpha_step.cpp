#include "dynamics/integration/generalized_alpha/generalized_alpha_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr int kMaxIterations = 8;
constexpr double kIterationShare = 0.05;   // error of the iteration, of what is allowed
constexpr double kNothingLeft = 1e-3;      // of what is allowed
constexpr double kSlowContraction = 0.15;  // beyond it another matrix is cheaper than the iterations
constexpr double kUselessContraction = 0.7;
// An iteration with the matrix of another length leaves this share of an error in a stiff mode, or makes it
// larger, and the norm of positions does not see it.
constexpr double kOutdated = 0.1;
constexpr int kNumFilters = 4;  // the U of (integration/generalized_alpha, eq. 8)
constexpr double kRounding =
    64.0 * std::numeric_limits<double>::epsilon();  // of a coordinate and its natural size

// Of the values and rates at both ends of a step for the cubic through them.
struct HermiteWeights {
  HermiteWeights(double begin_time, double end_time, double time) {
    const double length = end_time - begin_time, s = (time - begin_time) / length;
    end = s * s * (3.0 - 2.0 * s);
    begin = 1.0 - end;
    begin_rate = length * s * (1.0 - s) * (1.0 - s);
    end_rate = -length * s * s * (1.0 - s);
  }
  double begin, end, begin_rate, end_rate;
};

}  // namespace

GeneralizedAlphaStep::End::End(const Model& model, int num_switches)
    : motion(model),
      lead(motion.q),
      jerk(motion.q),
      mean_velocity(motion.q),
      lambda_rate(motion.lambda),
      energy(Pair::Zero()),
      power(Pair::Zero()),
      power_rate(Pair::Zero()),
      switches(Vector::Zero(num_switches)) {}

GeneralizedAlphaStep::GeneralizedAlphaStep(const Model& model, const SmoothPiece& piece,
                                           const GeneralizedAlpha& method, double tolerance)
    : model_(&model),
      piece_(&piece),
      method_(method),
      tolerance_(tolerance),
      scales_(model),
      residual_(model),
      newton_(model),
      begin_(model, piece.num_switches()),
      end_(begin_) {
  auxiliary_begin_ = auxiliary_end_ = delta_ = begin_.motion.q;
  vibration_ = error_ = error_q_ = error_v_ = error_force_ = begin_.motion.q;
  delta_lambda_ = scaled_phi_ = error_lambda_ = no_violation_ = begin_.motion.lambda;
}

void GeneralizedAlphaStep::reset() {
  begin_ = End(*model_, piece_->num_switches());
  smallest_pivot_ = 1.0;
}

void GeneralizedAlphaStep::advance() {
  std::swap(begin_, end_);
}

Index3Newton::Weights GeneralizedAlphaStep::weights(double length) const {
  return {.acceleration = (1.0 - method_.alpha_m) / (1.0 - method_.alpha_f),
          .velocity = method_.gamma * length,
          .position = method_.beta * length * length};
}

void GeneralizedAlphaStep::predict(double length) {
  const ConstrainedMotion& from = begin_.motion;
  auxiliary_begin_ = from.v_dot + length * begin_.lead;
  auxiliary_end_ = auxiliary_begin_ + length * begin_.jerk;
  end_.motion.lambda = from.lambda + length * begin_.lambda_rate;
  end_.motion.time = piece_->evaluation_time(from.time + length);
  apply_auxiliary(length);
}

// q, v and v̇ at the end by the auxiliary accelerations (integration/generalized_alpha, eqs. 1, 2).
void GeneralizedAlphaStep::apply_auxiliary(double length) {
  const ConstrainedMotion& from = begin_.motion;
  ConstrainedMotion& to = end_.motion;
  to.q = from.q + length * from.v +
         length * length * ((0.5 - method_.beta) * auxiliary_begin_ + method_.beta * auxiliary_end_);
  to.v = from.v + length * ((1.0 - method_.gamma) * auxiliary_begin_ + method_.gamma * auxiliary_end_);
  to.v_dot = ((1.0 - method_.alpha_m) * auxiliary_end_ + method_.alpha_m * auxiliary_begin_ -
              method_.alpha_f * from.v_dot) /
             (1.0 - method_.alpha_f);
}

// @return false where the matrix is singular
bool GeneralizedAlphaStep::renew_matrix(const Index3Newton::Weights& weights) {
  if (renewal_ == Renewal::kAll) newton_.linearise(residual_, end_.motion, piece_->branches());
  is_fresh_ = true;
  renewal_ = Renewal::kAll;
  if (!newton_.factorise(residual_.terms(), weights)) return false;
  factored_weights_ = weights;
  renewal_ = Renewal::kNone;
  return true;
}

// The error allowed in a position, and in a velocity: not less than the rounding of positions causes, which
// is large near a change point, and for velocities over a short step.
double GeneralizedAlphaStep::allowed_position(int i) const {
  return std::max(tolerance_ * scales_.position(i), rounding(i));
}

double GeneralizedAlphaStep::allowed_velocity(int i, double length) const {
  return std::max(tolerance_ * scales_.velocity(i, begin_.motion.v[i]),
                  rounding(i) * method_.gamma / (method_.beta * length));
}

double GeneralizedAlphaStep::rounding(int i) const {
  return kRounding / smallest_pivot_ * (model_->coordinate_scale(i) + std::abs(begin_.motion.q[i]));
}

// Root mean square of the last changes of q and v, each divided by the error that is allowed.
double GeneralizedAlphaStep::calc_iteration_norm(double length) const {
  const Index3Newton::Weights change = weights(length);
  double sum = 0.0;
  for (int i = 0; i < model_->num_coordinates; ++i) {
    sum += std::pow(change.position * delta_[i] / allowed_position(i), 2) +
           std::pow(change.velocity * delta_[i] / allowed_velocity(i, length), 2);
  }
  return std::sqrt(sum / (2.0 * model_->num_coordinates));
}

bool GeneralizedAlphaStep::iterate(double length) {
  const Index3Newton::Weights step_weights = weights(length);
  if (!(std::abs(step_weights.position / factored_weights_.position - 1.0) <= kOutdated)) renew_factors();
  predict(length);
  contraction_ = 0.0;
  double last = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    residual_.update(end_.motion, piece_->branches());
    if (renewal_ != Renewal::kNone && !renew_matrix(step_weights)) return false;
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

// Newton's iteration, repeated with a matrix of this step where it does not converge with the present one.
bool GeneralizedAlphaStep::solve(double length) {
  is_fresh_ = false;
  if (!iterate(length)) {
    ++iteration_failures_;
    if (is_fresh_) return false;
    renewal_ = Renewal::kAll;
    if (!iterate(length)) {
      renewal_ = Renewal::kAll;
      return false;
    }
  }
  end_.step_before = length;
  if (model_->has_modes()) {
    end_.mean_velocity = (end_.motion.q - begin_.motion.q) / length;
    settle_velocities(1.0, end_.motion.v);
    residual_.terms().update_velocities(end_.motion.v);  // for power and switches
  }
  // Positions and masses make the matrix out of date first; if it is slow with new ones, the forces do.
  if (contraction_ > kSlowContraction) renewal_ = is_fresh_ ? Renewal::kAll : Renewal::kFactors;
  return true;
}

// Velocities of modes that the step does not resolve become the slope of their positions
// (integration/generalized_alpha, eqs. 7, 8). @param place  in the step, 0 … 1
void GeneralizedAlphaStep::settle_velocities(double place, Vector& v) {
  const double length = end_.step_before, before = begin_.step_before;
  vibration_ = v - end_.mean_velocity;
  if (before > 0.0) {
    const double share = (2.0 * place - 1.0) * length / (length + before);
    vibration_ -= share * (end_.mean_velocity - begin_.mean_velocity);
  }
  for (int pass = 0; pass < kNumFilters; ++pass) {
    newton_.calc_force_change(vibration_, error_force_);
    error_force_ = -error_force_;
    newton_.solve(error_force_, no_violation_, vibration_, error_lambda_);
  }
  v -= vibration_;
}

// The part of an error in the coordinates that counts, by Newton's matrix: without what the constraints take
// away again, that is M⁻¹φ_qᵀ times anything, and without what stiff modes damp.
void GeneralizedAlphaStep::filter_error(const Vector& error, const Vector& scaled_phi, Vector& filtered) {
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const int first = model_->bodies[b].first_coordinate, size = model_->bodies[b].num_coordinates();
    error_force_.segment(first, size).noalias() = residual_.terms().mass(b) * error.segment(first, size);
  }
  error_force_.tail(model_->num_states()) = error.tail(model_->num_states());
  error_force_ *= -(1.0 - method_.alpha_m) / (1.0 - method_.alpha_f);
  newton_.solve(error_force_, scaled_phi, filtered, error_lambda_);
}

// Root mean square over q, v and the energies of the step's errors, each divided by the error that is allowed
// (integration/generalized_alpha, eq. 5).
double GeneralizedAlphaStep::calc_error(double length) {
  const double between = 0.5 * (length + begin_.step_before);  // of the middles of this step and the last
  const double cubed = std::pow(length, 3);
  error_ = (method_.position_error() * length * length) * (auxiliary_end_ - auxiliary_begin_);
  filter_error(error_, no_violation_, error_q_);
  error_ = (method_.velocity_error() * cubed / between) *
           ((auxiliary_end_ - auxiliary_begin_) / length - begin_.jerk);
  filter_error(error_, no_violation_, error_v_);
  double sum = 0.0;
  for (int i = 0; i < model_->num_coordinates; ++i) {
    sum += std::pow(error_q_[i] / allowed_position(i), 2) +
           std::pow(error_v_[i] / allowed_velocity(i, length), 2);
  }
  const Pair curvature = ((end_.power - begin_.power) / length - begin_.power_rate) / between;
  sum += (cubed / 12.0 * curvature / (tolerance_ * scales_.energy())).squaredNorm();
  return std::sqrt(sum / (2.0 * model_->num_coordinates + 2.0));
}

void GeneralizedAlphaStep::finish(double length, double end_time) {
  end_.motion.time = end_time;
  end_.lead = (auxiliary_end_ - end_.motion.v_dot) / length;
  end_.jerk = (auxiliary_end_ - auxiliary_begin_) / length;
  end_.lambda_rate = (end_.motion.lambda - begin_.motion.lambda) / length;
  end_.power_rate = (end_.power - begin_.power) / length;
  end_.energy = begin_.energy + 0.5 * length * (begin_.power + end_.power);
}

// Positions by the cubic through positions and velocities of both ends, velocities by that through velocities
// and accelerations.
void GeneralizedAlphaStep::interpolate_motion(double time, Vector& q, Vector& v) {
  const ConstrainedMotion &a = begin_.motion, &b = end_.motion;
  const HermiteWeights w(a.time, b.time, time);
  q = w.begin * a.q + w.end * b.q + w.begin_rate * a.v + w.end_rate * b.v;
  v = w.begin * a.v + w.end * b.v + w.begin_rate * a.v_dot + w.end_rate * b.v_dot;
  if (model_->has_modes()) settle_velocities((time - a.time) / (b.time - a.time), v);
}

void GeneralizedAlphaStep::remove_vibration(double time, const Vector& v_dot, const Vector& phi, Vector& q) {
  const ConstrainedMotion &a = begin_.motion, &b = end_.motion;
  const double share = (time - a.time) / (b.time - a.time);
  error_ = v_dot - (1.0 - share) * a.v_dot - share * b.v_dot;
  scaled_phi_ = factored_weights_.acceleration / factored_weights_.position * phi;
  SystemTerms& terms = residual_.terms();  // at the end of the step, or where a switch was looked for
  if (!terms.has(SystemTerms::Term::kMass)) terms.update_mass();
  filter_error(error_, scaled_phi_, error_q_);
  q += factored_weights_.position / factored_weights_.acceleration * error_q_;
}

// Accelerations and multipliers between those of the ends, less those of the equations.
void GeneralizedAlphaStep::calc_departure(const End& exact, End& departure) const {
  const ConstrainedMotion &a = begin_.motion, &b = end_.motion;
  const double share = (exact.motion.time - a.time) / (b.time - a.time);
  departure.motion.v_dot = (1.0 - share) * a.v_dot + share * b.v_dot - exact.motion.v_dot;
  departure.motion.lambda = (1.0 - share) * a.lambda + share * b.lambda - exact.motion.lambda;
  departure.lead = end_.lead - exact.lead;
  departure.jerk = end_.jerk - exact.jerk;
  departure.lambda_rate = end_.lambda_rate - exact.lambda_rate;
}

void GeneralizedAlphaStep::depart(const End& departure) {
  begin_.motion.v_dot += departure.motion.v_dot;
  begin_.motion.lambda += departure.motion.lambda;
  begin_.lead += departure.lead;
  begin_.jerk += departure.jerk;
  begin_.lambda_rate += departure.lambda_rate;
}

GeneralizedAlphaStep::Pair GeneralizedAlphaStep::interpolate_energy(double time) const {
  const HermiteWeights w(begin_.motion.time, end_.motion.time, time);
  return w.begin * begin_.energy + w.end * end_.energy + w.begin_rate * begin_.power +
         w.end_rate * end_.power;
}

}  // namespace sprung::dynamics
