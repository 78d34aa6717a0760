// Steps that are carried through forces which bend in them, on an oscillator whose damper has two rates:
// ẍ = −x − f(ẋ), f = c₁ẋ below the rate of the bend and f = f(bend) + c₂ (ẋ − bend) above.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "dynamics/integration/integrator.h"
#include "dynamics/integration/partitioned/make_integrator.h"
#include "dynamics/simulation/transient.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Integrator;
using dynamics::Passage;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBelow = 0.1, kAbove = 0.5;  // damping on either side

class TwoRates final : public dynamics::OdeSystem {
 public:
  Passage kind = Passage::kBendAtRest;
  bool refuses = false;
  double bend = 0.0;  // rate
  bool is_above = false;
  long num_evaluations = 0;

  double force(double rate) const { return kBelow * bend + (is_above ? kAbove : kBelow) * (rate - bend); }

  int size() const override { return 4; }
  int num_freedoms() const override { return 1; }
  bool calc_derivative(double /*time*/, std::span<const double> y, std::span<double> y_dot) override {
    ++num_evaluations;
    last_rate_ = y[1];
    y_dot[0] = y[1];
    y_dot[1] = -y[0] - force(y[1]);
    y_dot[2] = force(y[1]) * y[1];
    y_dot[3] = 0.0;
    return true;
  }
  int num_switches() const override { return 1; }
  bool calc_switches(double /*time*/, std::span<const double> y, std::span<double> values) override {
    values[0] = is_above ? y[1] - bend : bend - y[1];
    return true;
  }
  Passage passage(int /*switch_index*/) const override { return kind; }
  bool pass(int /*switch_index*/, double /*time*/, std::span<double> change) override {
    if (refuses) return false;
    before_ = is_above;
    has_passed_ = true;
    const double old_force = force(last_rate_);
    is_above = last_rate_ > bend;
    const double more = force(last_rate_) - old_force;
    change[0] = change[3] = 0.0;
    change[1] = -more;
    change[2] = more * last_rate_;
    return true;
  }
  void take_back_passes() override {
    if (has_passed_) is_above = before_;
  }
  void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
    std::fill(scales.begin(), scales.end(), 1.0);
  }
  bool calc_small_motion(double /*time*/, std::span<const double> /*y*/,
                         dynamics::SmallMotion& motion) override {
    motion.mass = Eigen::MatrixXd::Identity(1, 1);
    motion.damping = 0.3 * Eigen::MatrixXd::Identity(1, 1);
    motion.stiffness = 0.8 * Eigen::MatrixXd::Identity(1, 1);
    return true;
  }

 private:
  double last_rate_ = 0.0;
  bool before_ = false, has_passed_ = false;
};

// From rest at x = 1 with the bend at rest: half swings of the one oscillator and the other, in closed form.
std::array<double, 2> calc_swing(double time) {
  double amplitude = 1.0;
  for (bool above = false;; above = !above) {
    const double decay = 0.5 * (above ? kAbove : kBelow), omega = std::sqrt(1.0 - decay * decay);
    const double half = M_PI / omega;
    if (time <= half) {
      const double size = amplitude * std::exp(-decay * time);
      return {size * (std::cos(omega * time) + decay / omega * std::sin(omega * time)),
              -size * std::sin(omega * time) / omega};
    }
    amplitude *= -std::exp(-decay * half);
    time -= half;
  }
}

struct Outcome {
  std::array<double, 4> end;
  double worst_within = 0.0;  // of the motion, against the closed form
  long num_located = 0;
  Integrator::Statistics statistics;
};

Outcome run(TwoRates& system, double tolerance, double end_time) {
  const auto integrator = make_integrator(system, {.relative_tolerance = tolerance});
  std::vector<double> y{1.0, 0.0, 0.0, 0.0};
  integrator->start(0.0, y, end_time);
  Outcome outcome;
  while (true) {
    const double begin = integrator->time();
    const Integrator::StepResult result = integrator->step(kInfinity);
    for (const double share : {0.2, 0.5, 0.8, 1.0}) {
      const double time = begin + share * (integrator->time() - begin);
      integrator->interpolate(time, y);
      const auto [x, v] = calc_swing(time);
      outcome.worst_within = std::max({outcome.worst_within, std::abs(y[0] - x), std::abs(y[1] - v)});
    }
    if (result == Integrator::StepResult::kEnded) break;
    if (result != Integrator::StepResult::kSwitched) continue;
    ++outcome.num_located;
    system.is_above = !system.is_above;
    y.assign(integrator->y().begin(), integrator->y().end());
    integrator->start(integrator->time(), y, end_time);
  }
  std::copy(integrator->y().begin(), integrator->y().end(), outcome.end.begin());
  outcome.statistics = integrator->statistics();
  return outcome;
}

double energy(const Outcome& outcome) {
  return 0.5 * (outcome.end[0] * outcome.end[0] + outcome.end[1] * outcome.end[1]);
}

}  // namespace

TEST_CASE("Carried through bends, the motion is as exact as the tolerance asks", "[analysis]") {
  constexpr double kEnd = 20.0;  // behind six bends
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
    INFO("tolerance " << tolerance);
    TwoRates carried, cut;
    cut.kind = Passage::kJump;
    const Outcome with = run(carried, tolerance, kEnd), without = run(cut, tolerance, kEnd);
    CHECK(with.worst_within < 30.0 * tolerance);
    CHECK(std::abs(energy(with) + with.end[2] - 0.5) < 30.0 * tolerance);
    CHECK(without.worst_within < 30.0 * tolerance);
    CHECK(with.num_located + with.statistics.bends == 6);
    CHECK(without.num_located == 6);
    CHECK(without.statistics.bends == 0);
    if (tolerance < 1e-4) continue;
    CHECK(with.statistics.bends >= 4);
    CHECK(with.statistics.steps < without.statistics.steps);
    CHECK(carried.num_evaluations < cut.num_evaluations);
  }
}

TEST_CASE("The energy that a damper takes beyond a bend in motion is counted", "[analysis]") {
  // No closed form, but 0.5 (x² + v²) and what was dissipated are ½ together at all times.
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6}) {
    INFO("tolerance " << tolerance);
    TwoRates carried;
    carried.kind = Passage::kBend;
    carried.bend = 0.2;
    const Outcome outcome = run(carried, tolerance, 15.0);
    CHECK(outcome.num_located + outcome.statistics.bends >= 4);
    CHECK(std::abs(energy(outcome) + outcome.end[2] - 0.5) < 10.0 * tolerance);
  }
}

TEST_CASE("A bend that cannot be passed is located", "[analysis]") {
  TwoRates system;
  system.refuses = true;
  const Outcome outcome = run(system, 1e-4, 20.0);
  CHECK(outcome.num_located == 6);
  CHECK(outcome.statistics.bends == 0);
  CHECK(outcome.worst_within < 3e-3);
}

TEST_CASE("Outputs on either side of a bend within a step show the force that acts there", "[analysis]") {
  // The same motion as a body of 1 kg on a spring-damper of 1 N/m, drawn 1 m up. What the spring-damper does
  // is found from the acceleration.
  using dynamics::PiecewisePolynomial;
  dynamics::Model model;
  const int body = test::add_body(model, dynamics::make_rigid_body("body", 1.0, 1.0));
  dynamics::SpringDamper::Parameters parameters{
      .marker_a = test::add_marker(model, dynamics::kGround, {0.0, -10.0}),
      .marker_b = test::add_marker(model, body, {0.0, 0.0}),
      .free_length = 10.0,
      .spring = PiecewisePolynomial(std::vector<double>{0.0, 1.0}),
      .damper = PiecewisePolynomial::from_pieces({0.0}, {{0.0, kAbove}, {0.0, kBelow}})};
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>("suspension", parameters));
  dynamics::number_model(model);
  for (const double tolerance : {1e-3, 1e-5}) {
    INFO("tolerance " << tolerance);
    double worst = 0.0, worst_closure = 0.0;
    dynamics::TransientOptions options;
    options.end_time = 20.0;
    options.output_step = 0.02;
    options.integrator.relative_tolerance = tolerance;
    options.on_output = [&](const dynamics::Snapshot& snapshot) {
      const auto [x, v] = calc_swing(snapshot.time);
      const double acceleration = -x - (v > 0.0 ? kAbove : kBelow) * v;
      worst = std::max({worst, std::abs(snapshot.q[1] - x), std::abs(snapshot.v[1] - v),
                        std::abs(snapshot.v_dot[1] - acceleration)});
      worst_closure =
          std::max(worst_closure, std::abs(snapshot.energy.stored.total() + snapshot.energy.dissipated -
                                           snapshot.energy.input - 0.5));
    };
    const dynamics::State start =
        test::make_state(model, Eigen::Vector3d(0.0, 1.0, 0.0), Eigen::Vector3d::Zero());
    const dynamics::TransientStatistics statistics = dynamics::run_transient(model, start, options);
    CHECK(statistics.switches == 7);  // the first where it sets out
    CHECK(statistics.stepper.integrator.bends >= 3);
    CHECK(worst < 3.0 * tolerance);
    CHECK(worst_closure < tolerance);
  }
}
