#include "dynamics/analysis/exponential_integrator.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dynamics/analysis/oscillator_response.h"
#include "tools/support/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kNodes = 4;
const double kRoot5 = std::sqrt(5.0);
const std::array<double, kNodes> kNode = {0.0, (5.0 - kRoot5) / 10.0, (5.0 + kRoot5) / 10.0, 1.0};
// (θ − c₀)…(θ − c₃) by powers of θ.
const std::array<double, kNodes + 1> kNodePolynomial = {0.0, -0.2, 1.2, -2.0, 1.0};
constexpr std::array<double, kNodes + 1> kFactorial = {1.0, 1.0, 2.0, 6.0, 24.0};

constexpr double kShortestStep = 1e-12;     // s
constexpr double kSwitchTolerance = 1e-12;  // s
constexpr int kMaxSweeps = 6;

// Row k: coefficient of θ^k from the values at the nodes.
Eigen::Matrix4d make_interpolation() {
  Eigen::Matrix4d powers;
  for (int j = 0; j < kNodes; ++j) {
    for (int k = 0; k < kNodes; ++k) powers(j, k) = k == 0 ? 1.0 : std::pow(kNode[static_cast<std::size_t>(j)], k);
  }
  return powers.inverse();
}
const Eigen::Matrix4d kInterpolation = make_interpolation();

// Weights of the values at the nodes for the value of the cubic at θ.
Eigen::Vector4d cubic_weights(double theta) {
  return kInterpolation.transpose() * Eigen::Vector4d(1.0, theta, theta * theta, theta * theta * theta);
}

double node_polynomial(double theta) {
  double product = 1.0;
  for (const double c : kNode) product *= theta - c;
  return product;
}

double knob(const char* name, double value) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : value;
}

}  // namespace

ExponentialIntegrator::ExponentialIntegrator(OdeSystem& system, double relative_tolerance)
    : system_(system),
      tolerance_(relative_tolerance),
      f_(system.num_freedoms()),
      num_quadratures_(system.size() - 2 * system.num_freedoms()),
      num_switches_(system.num_switches()) {
  y_ = y_dot_ = scales_ = stage_y_ = difference_ = output_y_ = Vector::Zero(system.size());
  const Motion motion{Vector::Zero(f_), Vector::Zero(f_), Vector::Zero(num_quadratures_)};
  end_ = delta_ = output_ = motion;
  stages_.fill(motion);
  now_ = {.x = motion.x,
          .x_dot = motion.x_dot,
          .w = motion.w,
          .forces = NodeValues::Zero(f_, kNodes),
          .rates = NodeValues::Zero(num_quadratures_, kNodes)};
  last_ = now_;
  switches_ = Eigen::MatrixXd::Zero(num_switches_, kNodes);
}

void ExponentialIntegrator::linearise() {
  SmallMotion motion;
  if (!system_.calc_small_motion(time_, y(), motion)) {
    motion = {Eigen::MatrixXd::Identity(f_, f_), Eigen::MatrixXd::Zero(f_, f_), Eigen::MatrixXd::Zero(f_, f_)};
  }
  const Eigen::MatrixXd K = 0.5 * (motion.stiffness + motion.stiffness.transpose());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K, motion.mass);
  Phi_ = eigen.eigenvectors();
  inverse_ = Phi_.transpose() * motion.mass;
  stiffness_ = eigen.eigenvalues().cwiseMax(0.0);
  decay_ = (0.5 * (Phi_.transpose() * motion.damping * Phi_).diagonal()).cwiseMax(0.0);
  version_ = system_.coordinate_version();
  wants_linearisation_ = false;
  last_linearisation_ = statistics_.steps;
  propagator_length_ = 0.0;
  has_begun_ = has_history_ = can_predict_ = false;
}

void ExponentialIntegrator::start(double time, std::span<const double> y, double end_time) {
  if (statistics_.steps > 0) ++statistics_.restarts;
  time_ = step_start_ = time;
  end_time_ = end_time;
  std::copy(y.begin(), y.end(), y_.data());
  has_begun_ = has_history_ = false;
  can_predict_ = can_predict_ && last_.length > 0.0 && time >= last_.start && time <= last_.start + last_.length;
  if (version_ != system_.coordinate_version()) wants_linearisation_ = true;
  if (next_length_ <= 0.0) next_length_ = 1e-3;
}

void ExponentialIntegrator::update_propagator(double theta, double step, Propagator& propagator) const {
  Propagator& P = propagator;
  if (P.c.size() != f_) {
    P.c = P.s = P.c_rate = P.s_rate = P.truncation = P.truncation_rate = Eigen::ArrayXd::Zero(f_);
    P.force = P.force_rate = Eigen::Array<double, Eigen::Dynamic, kNodes>::Zero(f_, kNodes);
  }
  const double t = theta * step;
  std::array<double, kNodes + 1> scale;  // k!/h^k
  double power = 1.0;
  for (std::size_t k = 0; k <= kNodes; ++k) {
    scale[k] = kFactorial[k] / power;
    power *= step;
  }
  for (Eigen::Index m = 0; m < f_; ++m) {
    const OscillatorResponse r = calc_oscillator_response(stiffness_[m], decay_[m], t);
    P.c[m] = r.c;
    P.s[m] = r.s;
    P.c_rate[m] = r.c_rate;
    P.s_rate[m] = r.s_rate;
    std::array<double, kNodes + 1> forced, rate;
    for (int k = 0; k <= kNodes; ++k) {
      const auto i = static_cast<std::size_t>(k);
      forced[i] = scale[i] * r.forced[i];
      rate[i] = scale[i] * r.forced_rate(k);
    }
    double truncation = 0.0, truncation_rate = 0.0;
    for (std::size_t k = 0; k <= kNodes; ++k) {
      truncation += kNodePolynomial[k] * forced[k];
      truncation_rate += kNodePolynomial[k] * rate[k];
    }
    P.truncation[m] = truncation;
    P.truncation_rate[m] = truncation_rate;
    for (int j = 0; j < kNodes; ++j) {
      double sum = 0.0, sum_rate = 0.0;
      for (int k = 0; k < kNodes; ++k) {
        sum += kInterpolation(k, j) * forced[static_cast<std::size_t>(k)];
        sum_rate += kInterpolation(k, j) * rate[static_cast<std::size_t>(k)];
      }
      P.force(m, j) = sum;
      P.force_rate(m, j) = sum_rate;
    }
  }
  for (int j = 0; j < kNodes; ++j) {
    double sum = 0.0, theta_power = theta;
    for (int k = 0; k < kNodes; ++k) {
      sum += kInterpolation(k, j) * theta_power / (k + 1);
      theta_power *= theta;
    }
    P.quadrature[static_cast<std::size_t>(j)] = step * sum;
  }
  double sum = 0.0, theta_power = theta;
  for (int k = 0; k <= kNodes; ++k) {
    sum += kNodePolynomial[static_cast<std::size_t>(k)] * theta_power / (k + 1);
    theta_power *= theta;
  }
  P.quadrature_truncation = step * sum;
}

void ExponentialIntegrator::propagate(const Propagator& P, const Step& step, Motion& motion) const {
  motion.x.array() = P.c * step.x.array() + P.s * step.x_dot.array();
  motion.x_dot.array() = P.c_rate * step.x.array() + P.s_rate * step.x_dot.array();
  motion.w = step.w;
  for (int j = 0; j < kNodes; ++j) {
    motion.x.array() += P.force.col(j) * step.forces.col(j).array();
    motion.x_dot.array() += P.force_rate.col(j) * step.forces.col(j).array();
    motion.w += P.quadrature[static_cast<std::size_t>(j)] * step.rates.col(j);
  }
}

void ExponentialIntegrator::to_physical(const Motion& motion, Vector& y) const {
  y.head(f_).noalias() = Phi_ * motion.x;
  y.segment(f_, f_).noalias() = Phi_ * motion.x_dot;
  y.tail(num_quadratures_) = motion.w;
}

double ExponentialIntegrator::calc_norm(const Motion& motion) {
  to_physical(motion, difference_);
  return std::sqrt((difference_.array() / scales_.array()).square().mean());
}

bool ExponentialIntegrator::evaluate(double time, const Vector& y, const Vector& x, const Vector& x_dot, int node) {
  const std::span<const double> at{y.data(), static_cast<std::size_t>(y.size())};
  if (!system_.calc_derivative(time, at, {y_dot_.data(), static_cast<std::size_t>(y_dot_.size())})) return false;
  now_.forces.col(node).noalias() = inverse_ * y_dot_.segment(f_, f_);
  now_.forces.col(node).array() += stiffness_ * x.array() + 2.0 * decay_ * x_dot.array();
  now_.rates.col(node) = y_dot_.tail(num_quadratures_);
  return num_switches_ == 0 ||
         system_.calc_switches(time, at, {switches_.col(node).data(), static_cast<std::size_t>(num_switches_)});
}

bool ExponentialIntegrator::begin() {
  now_.x = inverse_ * y_.head(f_);
  now_.x_dot = inverse_ * y_.segment(f_, f_);
  now_.w = y_.tail(num_quadratures_);
  has_begun_ = true;
  return evaluate(time_, y_, now_.x, now_.x_dot, 0);
}

// The polynomial of the last step goes on; behind a switch it goes on beside itself, through the force that holds now.
void ExponentialIntegrator::predict_forces() {
  if (!can_predict_) {
    now_.forces.rightCols<kNodes - 1>().colwise() = now_.forces.col(0);
    now_.rates.rightCols<kNodes - 1>().colwise() = now_.rates.col(0);
    return;
  }
  const double origin = (now_.start - last_.start) / last_.length;
  Vector force_jump = Vector::Zero(f_), rate_jump = Vector::Zero(num_quadratures_);
  if (!has_history_) {
    const Eigen::Vector4d weights = cubic_weights(origin);
    force_jump = now_.forces.col(0) - last_.forces * weights;
    rate_jump = now_.rates.col(0) - last_.rates * weights;
  }
  for (int j = 1; j < kNodes; ++j) {
    const double theta = origin + kNode[static_cast<std::size_t>(j)] * now_.length / last_.length;
    const Eigen::Vector4d weights = cubic_weights(theta);
    now_.forces.col(j) = last_.forces * weights + force_jump;
    now_.rates.col(j) = last_.rates * weights + rate_jump;
    if (has_history_ && quartic_valid_) {
      now_.forces.col(j) += node_polynomial(theta) * last_quartic_force_;
      now_.rates.col(j) += node_polynomial(theta) * last_quartic_rate_;
    }
  }
}

bool ExponentialIntegrator::iterate() {
  static const double accept = knob("X_ACCEPT", 0.2);
  static const double reject = knob("X_REJECT", 4.0);
  double last_change = 0.0;
  for (int sweep = 1; sweep <= kMaxSweeps; ++sweep) {
    for (int i = 1; i < kNodes; ++i) {
      const auto node = static_cast<std::size_t>(i);
      Motion& stage = stages_[node];
      propagate(propagators_[node], now_, stage);
      to_physical(stage, stage_y_);
      if (!stage_y_.allFinite() || !evaluate(time_ + kNode[node] * now_.length, stage_y_, stage.x, stage.x_dot, i)) {
        return false;
      }
    }
    double change = 0.0;
    for (const std::size_t node : {std::size_t{1}, std::size_t{3}}) {
      propagate(propagators_[node], now_, end_);
      delta_.x = end_.x - stages_[node].x;
      delta_.x_dot = end_.x_dot - stages_[node].x_dot;
      change = std::max(change, calc_norm(delta_));
    }
    if (!std::isfinite(change)) return false;
    if (sweep > 1 && last_change > 0.0) contraction_ = std::max(0.02, 0.5 * (contraction_ + change / last_change));
    last_change = change;
    if (sweep < kMaxSweeps && calc_truncation() > reject) {
      sweeps_ = sweep;
      return true;
    }
    const double rate = std::min(0.9, contraction_);
    if (change * rate / (1.0 - rate) <= accept) {
      sweeps_ = sweep;
      return true;
    }
    if (sweep > 2 && contraction_ > 0.9) return false;
  }
  return false;
}

double ExponentialIntegrator::calc_truncation() {
  static const double first_factor = knob("X_FIRST", 0.3);
  Vector& force = quartic_force_;
  Vector& rate = quartic_rate_;
  if (has_history_) {
    const double theta = (kNode[2] - 1.0) * last_.length / now_.length;
    const Eigen::Vector4d weights = cubic_weights(theta);
    const double divisor = node_polynomial(theta);
    force = (last_.forces.col(2) - now_.forces * weights) / divisor;
    rate = (last_.rates.col(2) - now_.rates * weights) / divisor;
  } else {
    force = first_factor * (now_.forces * kInterpolation.row(3).transpose());
    rate = first_factor * (now_.rates * kInterpolation.row(3).transpose());
  }
  double sum = 0.0;
  for (const std::size_t node : {std::size_t{1}, std::size_t{3}}) {
    const Propagator& P = propagators_[node];
    delta_.x.array() = P.truncation * force.array();
    delta_.x_dot.array() = P.truncation_rate * force.array();
    delta_.w = P.quadrature_truncation * rate;
    sum += std::pow(calc_norm(delta_), 2);
  }
  delta_.w.setZero();
  return std::sqrt(sum);
}

Integrator::StepResult ExponentialIntegrator::step(double longest_step) {
  step_start_ = time_;
  if (end_time_ - time_ <= kShortestStep) return StepResult::kEnded;
  static const double grow = knob("X_GROW", 1.8);
  static const double gamma = knob("X_GAMMA", 0.8);
  static const double order = knob("X_ORDER", 5.0);
  static const bool verbose = knob("X_VERBOSE", 0.0) > 0.0;
  if (wants_linearisation_) linearise();
  if (!has_begun_ && !begin()) {
    throw support::NumericalError(fmt::format("integration stopped at t = {:.9g} s: no accelerations there", time_));
  }
  system_.calc_error_scales(y(), {scales_.data(), static_cast<std::size_t>(scales_.size())});
  scales_ *= tolerance_;

  double factor = 1.0;
  int rejections = 0;
  while (true) {
    double h = std::min(next_length_, longest_step);
    const double left = end_time_ - time_;
    bool to_end = false;
    if (h >= left * (1.0 - 1e-9)) h = left, to_end = true;
    else if (2.0 * h > left) h = 0.5 * left;
    if (h < kShortestStep) {
      throw support::NumericalError(fmt::format(
          "integration stopped at t = {:.9g} s: the step has become too short; look at forces and positions there", time_));
    }
    now_.start = time_;
    now_.length = h;
    if (h != propagator_length_) {
      for (std::size_t i = 1; i < kNodes; ++i) update_propagator(kNode[i], h, propagators_[i]);
      propagator_length_ = h;
    }
    predict_forces();
    if (!iterate()) {
      if (verbose) fmt::print("t {:.6f} h {:.2e} iteration failed {:.2f}\n", time_, h, contraction_);
      ++statistics_.iteration_failures;
      contraction_ = 0.3;
      has_history_ = can_predict_ = false;
      next_length_ = 0.5 * h;
      if (++rejections % 3 == 0 && last_linearisation_ < statistics_.steps) {
        wants_linearisation_ = true;
        return step(longest_step);
      }
      continue;
    }
    const double error = calc_truncation();
    static const double memory = knob("X_MEMORY", 0.3);
    factor = std::clamp(gamma * std::pow(std::max({error, memory * last_error_, 1e-10}), -1.0 / order), 0.2, grow);
    last_error_ = error;
    if (verbose) fmt::print("t {:.6f} h {:.2e} err {:.2e} contraction {:.2f} hist {} sweeps {}\n", time_, h, error, contraction_, has_history_, sweeps_);
    if (error <= 1.0) {
      time_ = to_end ? end_time_ : time_ + h;
      if (factor > 1.15 || factor < 0.95) next_length_ = factor < 1.0 ? h * factor : std::max(next_length_, h * factor);
      break;
    }
    ++statistics_.error_test_failures;
    next_length_ = std::min(factor, 0.9) * h;
  }
  ++statistics_.steps;
  const bool switched = num_switches_ > 0 && locate_switch();
  std::swap(now_, last_);
  can_predict_ = true;
  quartic_valid_ = has_history_;
  std::swap(last_quartic_force_, quartic_force_);
  std::swap(last_quartic_rate_, quartic_rate_);
  if (switched) {
    to_physical(output_, y_);
    has_begun_ = false;
    return StepResult::kSwitched;
  }
  propagate(propagators_[3], last_, end_);
  to_physical(end_, y_);
  now_.x = end_.x;
  now_.x_dot = end_.x_dot;
  now_.w = end_.w;
  now_.forces.col(0) = last_.forces.col(3);
  now_.rates.col(0) = last_.rates.col(3);
  if (num_switches_ > 0) switches_.col(0) = switches_.col(3).eval();
  has_history_ = true;
  return time_ >= end_time_ ? StepResult::kEnded : StepResult::kStepped;
}

bool ExponentialIntegrator::locate_switch() {
  const auto crosses = [](double before, double after) {
    return before * after < 0.0 || (after == 0.0 && before != 0.0);
  };
  const auto any_crosses = [&](const auto& before, const auto& after) {
    for (Eigen::Index i = 0; i < num_switches_; ++i) {
      if (crosses(before[i], after[i])) return true;
    }
    return false;
  };
  int bracket = 0;
  for (int j = 1; j < kNodes && bracket == 0; ++j) {
    if (any_crosses(switches_.col(j - 1), switches_.col(j))) bracket = j;
  }
  if (bracket == 0) return false;
  double low = kNode[static_cast<std::size_t>(bracket - 1)], high = kNode[static_cast<std::size_t>(bracket)];
  Vector g_low = switches_.col(bracket - 1), g_high = switches_.col(bracket), g(num_switches_);
  const double tolerance = std::max(kSwitchTolerance, 4e-16 * std::abs(time_)) / now_.length;
  double weight = 1.0;  // of the value at `high`; the Illinois rule
  int side = 0;
  for (int iteration = 0; iteration < 60 && high - low > tolerance; ++iteration) {
    double theta = high;
    for (Eigen::Index i = 0; i < num_switches_; ++i) {
      if (!crosses(g_low[i], g_high[i])) continue;
      theta = std::min(theta, low + (high - low) * g_low[i] / (g_low[i] - weight * g_high[i]));
    }
    theta = std::clamp(theta, low + 0.5 * tolerance, high - 0.5 * tolerance);
    update_propagator(theta, now_.length, output_propagator_);
    propagate(output_propagator_, now_, output_);
    to_physical(output_, stage_y_);
    if (!system_.calc_switches(now_.start + theta * now_.length,
                               {stage_y_.data(), static_cast<std::size_t>(stage_y_.size())},
                               {g.data(), static_cast<std::size_t>(num_switches_)})) {
      throw support::NumericalError(fmt::format("integration stopped at t = {:.9g} s: no positions there", time_));
    }
    if (any_crosses(g_low, g)) {
      high = theta;
      g_high = g;
      weight = side == 1 ? 2.0 * weight : 1.0;
      side = 1;
    } else {
      low = theta;
      g_low = g;
      weight = side == -1 ? 0.5 * weight : 1.0;
      side = -1;
    }
  }
  time_ = now_.start + high * now_.length;
  update_propagator(high, now_.length, output_propagator_);
  propagate(output_propagator_, now_, output_);
  return true;
}

void ExponentialIntegrator::interpolate(double time, std::span<double> y) const {
  update_propagator((time - last_.start) / last_.length, last_.length, output_propagator_);
  propagate(output_propagator_, last_, output_);
  to_physical(output_, output_y_);
  std::copy(output_y_.begin(), output_y_.end(), y.begin());
}

}  // namespace sprung::dynamics
