#include "dynamics/integration/exponential/exponential_integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/integration/throw_stopped.h"
#include "tools/support/dense/vector_span.h"

namespace sprung::dynamics {

namespace {

using lobatto::combine;
using lobatto::cubic_weights;
using lobatto::node_polynomial;

constexpr double kFirstLength = 1e-3;    // s; a step that is too long is repeated
constexpr double kShortestStep = 1e-12;  // s

constexpr int kMaxSweeps = 6;
constexpr double kIterationShare = 0.3;    // error of the iteration, of what is allowed
constexpr double kFirstContraction = 0.3;  // until it is known
constexpr double kLeastContraction = 0.02;
constexpr double kUselessContraction = 0.9;
constexpr double kHopelessError =
    2.0;  // of what is allowed: a step with more is given up before its iteration ends
// The pairs may be those of a state long past. Three things show it: iterations that fail; iterations that
// are slow step after step; and errors that the steps before did not foretell, again and again. Such an error
// is that of an iteration that diverges, where the pairs lack a stiff part of the motion.
constexpr double kFailuresBeforeLinearising = 2.5, kFailureMemory = 0.8;
constexpr double kSlowContraction = 0.4, kSlowness = 0.75;
constexpr double kForetold = 10.0, kSurprise = 1.35;

constexpr double kFastVibration = 4.0;  // rad in a step

// Measured errors of accelerations over those that the parts of fourth degree give.
constexpr double kErrorFactor = 3.0;

// Step control: the truncation within a step is of order 5.
constexpr double kSafety = 0.75, kOrder = 5.0, kLeastFactor = 0.2, kLargestFactor = 1.8;
constexpr double kMemory =
    0.5;  // share of the last step's error that counts: an estimate may pass through zero
// A step is kept as it is where a better one would hardly be longer: its propagators can be used again.
constexpr double kWorthwhile = 1.15;
// A step that may hide a switch is repeated with this part of its length; the bound on the length of later
// steps grows slowly.
constexpr double kOfHiding = 0.5, kForgetting = 1.1;
constexpr double kTruncationOfFirst =
    0.3;  // part of fourth degree over that of third, for a step without one before it

// Error in the time of a switch at a tolerance of 1: a force that begins so late changes the velocity by far
// less than is allowed.
constexpr double kSwitchTolerance = 1e-4;        // s
constexpr double kLeastSwitchTolerance = 1e-12;  // s

}  // namespace

ExponentialIntegrator::ExponentialIntegrator(OdeSystem& system, double relative_tolerance)
    : system_(system),
      tolerance_(relative_tolerance),
      coordinates_(system.num_freedoms(), system.size()),
      y_(Vector::Zero(system.size())),
      now_(system.num_freedoms(), system.size() - 2 * system.num_freedoms()),
      last_(now_),
      switches_(system, now_.motion),
      prediction_(system.num_freedoms(), now_.motion.w.size()),
      contraction_(kFirstContraction),
      vibration_error_(system.num_freedoms()) {
  if (system.num_freedoms() == 0) throw std::invalid_argument("ExponentialIntegrator: needs a freedom");
  y_dot_ = stage_y_ = error_sizes_ = between_y_ = y_;
  end_ = again_ = change_ = drive_at_ = truncated_ = at_switch_ = between_motion_ = now_.motion;
  stages_.fill(now_.motion);
  between_ = LobattoPropagator(system.num_freedoms());
  propagators_.fill(between_);
}

void ExponentialIntegrator::start(double time, std::span<const double> y, double end_time) {
  if (statistics_.steps > 0) ++statistics_.restarts;
  const bool follows = last_.length > 0.0 && time == time_;
  time_ = time;
  end_time_ = end_time;
  std::copy(y.begin(), y.end(), y_.data());
  has_begun_ = false;
  past_ = follows ? Past::kSwitched : Past::kNone;
  if (version_ != system_.coordinate_version()) wants_linearisation_ = true;
  if (next_length_ == 0.0) next_length_ = kFirstLength;
}

// Any pairs are right: the drive holds all of the accelerations that they leave out.
void ExponentialIntegrator::linearise() {
  if (!system_.calc_small_motion(time_, y(), small_motion_)) {
    const Eigen::Index f = system_.num_freedoms();
    small_motion_ = {Eigen::MatrixXd::Identity(f, f), Eigen::MatrixXd::Zero(f, f),
                     Eigen::MatrixXd::Zero(f, f)};
  }
  update_pairs();
  mass_columns_.resize(system_.num_freedoms(), std::ssize(coordinates_.shear().others()));
  switches_.forget_propagators();
  propagator_length_ = 0.0;
  version_ = system_.coordinate_version();
  wants_linearisation_ = has_begun_ = false;
  last_linearisation_ = statistics_.steps;
  failures_ = 0.0;
  past_ = Past::kNone;
}

// The estimated error remains where the coordinates in y are the same.
void ExponentialIntegrator::update_pairs() {
  const bool remains = last_.length > 0.0 && version_ == system_.coordinate_version();
  error_change_.setZero(2 * system_.num_freedoms());
  if (remains) coordinates_.to_state_change(vibration_error_.at_end(), now_, 0.0, error_change_);
  coordinates_.update(small_motion_, system_.elastic_freedoms(), y_);
  now_.shear = last_.shear = coordinates_.shear().no_course();
  now_.elastic = last_.elastic = coordinates_.shear().no_motion();
  coordinates_.to_pair_change(error_change_, now_, 0.0, error_pairs_);
  // Other coordinates do not add to an error. Nearly parallel pairs would, time and again.
  const double size = vibration_error_.at_end().norm(), changed = error_pairs_.norm();
  if (changed > size) error_pairs_ *= size / changed;
  vibration_error_.set_at_end(error_pairs_);
}

void ExponentialIntegrator::begin() {
  coordinates_.to_pairs(y_, now_, now_.motion);
  stage_y_ = y_;
  if (!evaluate(time_, now_.motion, 0))
    throw_stopped(time_, "no accelerations can be found there: the position may be a singular one");
  switches_.start_from(0);
  has_begun_ = true;
}

// The shear of now_ shall reach what inertia asks for where now_ is predicted to end. It stays where
// vibration is slow: that is a polynomial over a step, to the accuracy of the drive. @return whether drives
// have changed
bool ExponentialIntegrator::aim_shear() {
  const InertialShear& shear = coordinates_.shear();
  if (!shear.is_useful()) return false;
  const Eigen::MatrixXd* columns = nullptr;
  if (coordinates_.highest_frequency() * now_.length > kFastVibration) {
    PairedMotion& end = stages_.back();
    now_.propagate(propagators_.back(), coordinates_.blocks(), end);
    coordinates_.to_state(end, now_, now_.length, stage_y_);
    const double end_time = now_.start + now_.length;
    if (system_.calc_mass_columns(end_time, support::as_span(stage_y_), shear.others(), mass_columns_))
      columns = &mass_columns_;
  }
  return coordinates_.aim_shear(columns, now_, last_);
}

// The drive at stage_y_, the state of `motion`.
bool ExponentialIntegrator::evaluate(double time, const PairedMotion& motion, int node) {
  if (!stage_y_.allFinite() ||
      !system_.calc_derivative(time, support::as_span(stage_y_), support::as_span(y_dot_)))
    return false;
  coordinates_.calc_drive(stage_y_, y_dot_, motion, node, now_);
  return switches_.is_empty() || switches_.evaluate(time, support::as_span(stage_y_), node);
}

// Sweeps over the nodes until the motion no longer changes. @return false where it does not settle
bool ExponentialIntegrator::iterate() {
  double last_change = 0.0;
  for (int sweep = 1; sweep <= kMaxSweeps; ++sweep) {
    for (int i = 1; i < kNumNodes; ++i) {
      const auto node = static_cast<std::size_t>(i);
      now_.propagate(propagators_[node], coordinates_.blocks(), stages_[node]);
      const double t = lobatto::node(i) * now_.length;
      coordinates_.to_state(stages_[node], now_, t, stage_y_);
      if (!evaluate(now_.start + t, stages_[node], i)) return false;
      if (sweep == 1) prediction_.correct(i, now_);
    }
    const double within = calc_change(1, again_), at_end = calc_change(kNumNodes - 1, end_);
    if (!std::isfinite(within) || !std::isfinite(at_end)) return false;
    const double change = std::max(within, at_end);
    if (sweep > 1 && last_change > 0.0) {
      contraction_ = std::max(kLeastContraction, 0.5 * (contraction_ + change / last_change));
      if (sweep > 2 && contraction_ > kUselessContraction) return false;
    }
    last_change = change;
    const double rate = std::min(kUselessContraction, contraction_);
    if (change * rate / (1.0 - rate) <= kIterationShare || calc_truncation() > kHopelessError) return true;
  }
  return false;
}

// Motion at a node by the present drive. @return norm of its difference from that of the last sweep
double ExponentialIntegrator::calc_change(std::size_t node, PairedMotion& motion) {
  now_.propagate(propagators_[node], coordinates_.blocks(), motion);
  change_.u = motion.u - stages_[node].u;
  change_.w.setZero();
  return coordinates_.calc_norm(change_, now_);
}

// Coefficients of the part of fourth degree: by the drive at one more point, the third node of the step
// before.
void ExponentialIntegrator::estimate_quartic() {
  now_.has_quartic = past_ == Past::kSmooth;
  if (!now_.has_quartic) {
    const lobatto::NodeWeights third = kTruncationOfFirst * lobatto::third_degree_weights();
    combine(now_.drive.pairs, third, now_.quartic.u);
    combine(now_.drive.rates, third, now_.quartic.w);
    return;
  }
  last_.calc_drive(lobatto::node(2), drive_at_);
  const double theta = (lobatto::node(2) - 1.0) * last_.length / now_.length;
  const lobatto::NodeWeights weights = cubic_weights(theta);
  combine(now_.drive.pairs, weights, now_.quartic.u);
  combine(now_.drive.rates, weights, now_.quartic.w);
  const double divisor = node_polynomial(theta);
  now_.quartic.u = (drive_at_.u - now_.quartic.u) / divisor;
  now_.quartic.w = (drive_at_.w - now_.quartic.w) / divisor;
}

// The truncation error: the effect of a part of fourth degree, which the cubics lack, at the second node and
// at the end.
double ExponentialIntegrator::calc_truncation() {
  estimate_quartic();
  double sum = 0.0;
  for (const std::size_t node : {std::size_t{1}, std::size_t{3}}) {
    now_.propagate_quartic(propagators_[node], coordinates_.blocks(), truncated_);
    const double size = coordinates_.calc_norm(truncated_, now_);
    sum += size * size;
  }
  return std::sqrt(sum);
}

double ExponentialIntegrator::choose_length(double longest_step) const {
  const double left = end_time_ - time_;
  double length = std::min({next_length_, longest_step, 0.99 * hiding_length_});
  if (propagator_length_ <= length && length < kWorthwhile * propagator_length_) length = propagator_length_;
  if (length >= left * (1.0 - 1e-9)) return left;
  return 2.0 * length > left ? 0.5 * left : length;
}

Integrator::StepResult ExponentialIntegrator::step(double longest_step) {
  if (end_time_ - time_ <= kShortestStep) {
    time_ = end_time_;
    return StepResult::kEnded;
  }
  system_.calc_error_scales(y(), support::as_span(error_sizes_));
  coordinates_.set_allowed_error(tolerance_, error_sizes_);
  if (wants_linearisation_) linearise();
  if (!has_begun_) begin();

  double factor = 1.0;
  while (true) {
    now_.start = time_;
    now_.length = choose_length(longest_step);
    if (now_.length < kShortestStep) {
      throw_stopped(
          time_,
          "the step has become too short; look at forces and positions just before that time, which "
          "may be a singular one");
    }
    update_propagators();
    prediction_.predict(last_, past_, now_);
    if (aim_shear()) prediction_.predict(last_, past_, now_);
    if (!iterate()) {
      give_up_iteration();
      continue;
    }
    const double error = calc_truncation();
    if (is_surprise(error)) failures_ += kSurprise;
    factor = kSafety * std::pow(std::max({error, kMemory * last_error_, 1e-10}), -1.0 / kOrder);
    factor = std::clamp(factor, kLeastFactor, kLargestFactor);
    last_error_ = error;
    if (error <= 1.0) {
      if (switches_.is_empty() || !switches_.may_hide(now_, stages_, coordinates_)) break;
      hiding_length_ = now_.length;
      factor = kOfHiding;
    }
    ++statistics_.error_test_failures;
    next_length_ = std::min(factor, 0.9) * now_.length;
    renew_linearisation();
  }
  ++statistics_.steps;
  hiding_length_ *= kForgetting;
  failures_ *= kFailureMemory;
  if (contraction_ > kSlowContraction) failures_ += kSlowness;
  if (has_outlived_linearisation()) wants_linearisation_ = true;
  if (factor < 1.0 / kWorthwhile) next_length_ = factor * now_.length;
  if (factor > kWorthwhile) next_length_ = std::max(next_length_, factor * now_.length);
  if (finish_step()) return StepResult::kSwitched;
  return time_ >= end_time_ ? StepResult::kEnded : StepResult::kStepped;
}

void ExponentialIntegrator::update_propagators() {
  if (now_.length == propagator_length_) return;
  for (int i = 1; i < kNumNodes; ++i) {
    propagators_[static_cast<std::size_t>(i)].update(lobatto::node(i), now_.length, coordinates_.blocks());
  }
  propagator_length_ = now_.length;
}

// @param error  of now_: is it far above what the error of the last step and the order foretell?
bool ExponentialIntegrator::is_surprise(double error) const {
  if (error <= kHopelessError || past_ != Past::kSmooth) return false;
  return error > kForetold * last_error_ * std::pow(now_.length / last_.length, kOrder);
}

// The next attempt is half as long, and where iterations keep failing it is about a new linearisation.
void ExponentialIntegrator::give_up_iteration() {
  ++statistics_.iteration_failures;
  contraction_ = kFirstContraction;
  past_ = Past::kNone;
  next_length_ = 0.5 * now_.length;
  failures_ += 1.0;
  renew_linearisation();
}

// Before another attempt of a step.
void ExponentialIntegrator::renew_linearisation() {
  if (!has_outlived_linearisation()) return;
  linearise();
  begin();
}

bool ExponentialIntegrator::has_outlived_linearisation() const {
  return failures_ >= kFailuresBeforeLinearising && last_linearisation_ < statistics_.steps;
}

// Makes now_ the last step; the next one starts at its end. @return true if a switch cut it off
bool ExponentialIntegrator::finish_step() {
  vibration_error_.add_step(now_, propagators_[kNumNodes - 1], coordinates_.blocks());
  between_time_ = std::numeric_limits<double>::quiet_NaN();
  if (switches_.crosses()) {
    locate_switch();
    std::swap(now_, last_);
    coordinates_.to_state(at_switch_, last_, time_ - last_.start, y_);
    now_.shear = last_.shear;
    now_.shear.go_on(time_ - last_.start);
    has_begun_ = false;
    return true;
  }
  time_ = end_time_ - now_.start <= now_.length ? end_time_ : now_.start + now_.length;
  now_.add_quartic(propagators_[kNumNodes - 1], coordinates_.blocks(), end_);
  coordinates_.to_state(end_, now_, now_.length, y_);
  std::swap(now_, last_);
  now_.shear = last_.shear;
  now_.shear.go_on(last_.length);
  now_.elastic.start_from(kNumNodes - 1, last_.elastic);
  std::swap(now_.motion, end_);
  last_.calc_drive(1.0, drive_at_);
  now_.drive.set(0, drive_at_);
  switches_.start_from(kNumNodes - 1);
  past_ = Past::kSmooth;
  return false;
}

// Finds the first zero of a switch function in now_: time_ and at_switch_.
void ExponentialIntegrator::locate_switch() {
  const double tolerance =
      std::max({kSwitchTolerance * tolerance_, kLeastSwitchTolerance, 4e-16 * std::abs(time_)});
  const double theta = switches_.locate(now_, coordinates_, tolerance, at_switch_);
  time_ = now_.start + theta * now_.length;
}

void ExponentialIntegrator::interpolate(double time, std::span<double> y) const {
  const double theta = (time - last_.start) / last_.length;
  between_.update(theta, last_.length, coordinates_.blocks());
  between_time_ = time;
  last_.propagate(between_, coordinates_.blocks(), between_motion_);
  last_.add_quartic(between_, coordinates_.blocks(), between_motion_);
  coordinates_.to_state(between_motion_, last_, time - last_.start, between_y_);
  std::copy(between_y_.begin(), between_y_.end(), y.begin());
}

// Of the error that vibrates in the pairs, at a time that was interpolated last, or at the end of the step.
bool ExponentialIntegrator::estimate_acceleration_error(double time, Eigen::VectorXd& error) const {
  if (!(last_.length > 0.0) || version_ != system_.coordinate_version()) return false;
  if (time == between_time_) {
    vibration_error_.calc_within(last_, between_, coordinates_.blocks(), error_pairs_);
  } else {
    error_pairs_ = vibration_error_.at_end();
  }
  error_rates_.setZero(error_pairs_.size());
  coordinates_.blocks().subtract_product(-error_pairs_, error_rates_);
  coordinates_.to_state_change(error_rates_, last_, time - last_.start, error_change_);
  error = kErrorFactor * error_change_.tail(system_.num_freedoms());
  return true;
}

}  // namespace sprung::dynamics
