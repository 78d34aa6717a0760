#include "tests/benchmark/dense_baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/support/errors/numerical_error.h"

namespace sprung::benchmark {

namespace {

constexpr std::array<std::array<double, 6>, 6> kA{{
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
}};
// Order 5 less order 4.
constexpr std::array<double, 7> kError{71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                                       -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
// Of the continuous extension.
constexpr std::array<double, 7> kDense{-12715105075.0 / 11282082432.0,  0.0,
                                       87487479700.0 / 32700410799.0,   -10690763975.0 / 1880347072.0,
                                       701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
                                       69997945.0 / 29380423.0};
constexpr double kShortestStep = 1e-12;  // s

}  // namespace

DenseBaseline::DenseBaseline(const dynamics::Model& model, const dynamics::State& start)
    : evaluator_(model), ode_(model) {
  ode_.set_state(start, 0.0, 0.0);
  ode_.make_state(start.time, ode_.y());
  partition_ = ode_.equations().partition();
  start_q_ = start.q;
  start_v_ = start.v;
  start_y_ = Eigen::Map<const Vector>(ode_.y().data(), 2 * ode_.num_freedoms());
  for (Vector& k : k_) k = Vector::Zero(start_y_.size());
}

bool DenseBaseline::evaluate(const Vector& y, Vector& y_dot) {
  ++statistics_.evaluations;
  const std::size_t f = partition_.independent.size();
  for (std::size_t i = 0; i < f; ++i) {
    q_[partition_.independent[i]] = y[static_cast<Eigen::Index>(i)];
    v_[partition_.independent[i]] = y[static_cast<Eigen::Index>(f + i)];
  }
  if (!y.allFinite() || !evaluator_.solve_positions(partition_.dependent, q_)) return false;
  evaluator_.solve_velocities(partition_.dependent, q_, v_);
  evaluator_.solve_accelerations(q_, v_);
  for (std::size_t i = 0; i < f; ++i) {
    y_dot[static_cast<Eigen::Index>(i)] = y[static_cast<Eigen::Index>(f + i)];
    y_dot[static_cast<Eigen::Index>(f + i)] = evaluator_.v_dot()[partition_.independent[i]];
  }
  return y_dot.allFinite();
}

void DenseBaseline::write_outputs(double time, double step, const Vector& y, const Vector& y_new,
                                  double end_time, double output_step, const Output& output) {
  const double slack = 1e-9 * output_step;
  Vector at(y.size()), rate(y.size());
  const Vector change = y_new - y, first = step * k_[0] - change, second = change - step * k_[6] - first;
  Vector third = Vector::Zero(y.size());
  for (std::size_t i = 0; i < k_.size(); ++i) third += step * kDense[i] * k_[i];
  const long evaluations = statistics_.evaluations;
  for (;; ++next_output_) {
    const double next = static_cast<double>(next_output_) * output_step;
    if (next > std::min(end_time, time + step) + slack) break;
    const double s = std::min(1.0, (next - time) / step);
    at = y + s * (change + (1.0 - s) * (first + s * (second + (1.0 - s) * third)));
    if (!evaluate(at, rate))
      throw support::NumericalError(fmt::format("dense baseline: stopped at t = {} s", next));
    output(next, q_, evaluator_.v_dot());
  }
  statistics_.evaluations = evaluations;  // those of the integration alone
}

DenseBaseline::Statistics DenseBaseline::run(double end_time, double tolerance, double largest_step,
                                             double output_step, const Output& output) {
  statistics_ = {};
  next_output_ = 0;
  q_ = start_q_;
  v_ = start_v_;
  Vector y = start_y_, y_new = y, stage = y, error = y, scales = Vector::Zero(ode_.size()), scaled_y = scales;
  double time = 0.0, step = std::min(1e-4, largest_step), factor_limit = 5.0;
  if (!evaluate(y, k_[0])) throw support::NumericalError("dense baseline: no accelerations at the start");
  while (end_time - time > kShortestStep) {
    step = std::min({step, largest_step, end_time - time});
    bool good = true;
    for (std::size_t i = 0; good && i < kA.size(); ++i) {
      stage = y;
      for (std::size_t j = 0; j <= i; ++j) stage += step * kA[i][j] * k_[j];
      good = evaluate(stage, k_[i + 1]);
    }
    double size = 1e10;
    if (good) {
      y_new = stage;
      error.setZero();
      for (std::size_t i = 0; i < k_.size(); ++i) error += step * kError[i] * k_[i];
      scaled_y.head(y.size()) = y;
      ode_.calc_error_scales({scaled_y.data(), static_cast<std::size_t>(scaled_y.size())},
                             {scales.data(), static_cast<std::size_t>(scales.size())});
      size = std::sqrt((error.array() / (tolerance * scales.head(y.size()).array())).square().mean());
    }
    const double factor = std::clamp(0.9 * std::pow(std::max(size, 1e-10), -0.2), 0.2, factor_limit);
    if (!(size <= 1.0)) {
      ++statistics_.rejected;
      factor_limit = 1.0;
      step *= factor;
      if (step < kShortestStep)
        throw support::NumericalError(fmt::format("dense baseline: stopped at t = {} s", time));
      continue;
    }
    if (output) write_outputs(time, step, y, y_new, end_time, output_step, output);
    ++statistics_.steps;
    time += step;
    std::swap(y, y_new);
    std::swap(k_[0], k_[6]);
    step *= factor;
    factor_limit = 5.0;
  }
  return statistics_;
}

}  // namespace sprung::benchmark
