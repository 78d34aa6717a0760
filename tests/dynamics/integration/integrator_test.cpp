// Requirements on every integrator, on ẍ = −x + ε x³, of which the exponential one is given the linear part
// alone.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "dynamics/integration/integrator.h"
#include "dynamics/integration/partitioned/make_integrator.h"
#include "tests/catch.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;
using dynamics::Integrator;
using Method = Integrator::Method;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Switches where x comes to ½ from the side told by `above`, and at t = 2 until `is_late`; beyond `wall` it
// cannot be evaluated.
class Oscillator final : public dynamics::OdeSystem {
 public:
  double wall = kInfinity;
  bool has_switches = false, above = true, is_late = false;
  double known_stiffness = 1.0;  // that calc_small_motion tells
  double cubic = 0.0;
  long num_evaluations = 0;

  int size() const override { return 2; }
  int num_freedoms() const override { return 1; }
  bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) override {
    ++num_evaluations;
    if (time > wall) return false;
    y_dot[0] = y[1];
    y_dot[1] = -y[0] + cubic * y[0] * y[0] * y[0];
    return true;
  }
  int num_switches() const override { return has_switches ? 2 : 0; }
  bool calc_switches(double time, std::span<const double> y, std::span<double> values) override {
    values[0] = above ? y[0] - 0.5 : 0.5 - y[0];
    values[1] = is_late ? 1.0 : 2.0 - time;
    return true;
  }
  void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
    scales[0] = scales[1] = 1.0;
  }
  bool calc_small_motion(double /*time*/, std::span<const double> /*y*/,
                         dynamics::SmallMotion& motion) override {
    motion.mass = Eigen::MatrixXd::Identity(1, 1);
    motion.damping = Eigen::MatrixXd::Zero(1, 1);
    motion.stiffness = known_stiffness * Eigen::MatrixXd::Identity(1, 1);
    return true;
  }
};

std::array<double, 2> run_to_ten(Oscillator& oscillator, Method method, double tolerance) {
  const auto integrator = make_integrator(oscillator, {.method = method, .relative_tolerance = tolerance});
  integrator->start(0.0, std::array{1.0, 0.0}, 10.0);
  while (integrator->step(kInfinity) != Integrator::StepResult::kEnded) {
  }
  CHECK(integrator->time() == 10.0);
  return {integrator->y()[0], integrator->y()[1]};
}

}  // namespace

TEST_CASE("The harmonic oscillator's error follows the tolerance, with each method", "[analysis]") {
  for (const Method method : {Method::kAdams, Method::kBdf, Method::kExponential}) {
    double last = 1.0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      Oscillator oscillator;
      oscillator.known_stiffness = 0.8;
      const auto [x, v] = run_to_ten(oscillator, method, tolerance);
      const double error = std::hypot(x - std::cos(10.0), v + std::sin(10.0));
      CHECK(error < 300.0 * tolerance);
      CHECK(error < last);
      last = error;
    }
  }
}

TEST_CASE("The methods agree on an oscillator that is not linear", "[analysis]") {
  Oscillator oscillator;
  oscillator.cubic = 0.5;
  const auto [x, v] = run_to_ten(oscillator, Method::kAdams, 1e-12);
  for (const Method method : {Method::kBdf, Method::kExponential}) {
    const auto [other_x, other_v] = run_to_ten(oscillator, method, 1e-9);
    CHECK(other_x == Approx(x).margin(1e-6));
    CHECK(other_v == Approx(v).margin(1e-6));
  }
}

TEST_CASE("Steps are at most the longest allowed, and the solution is available within them", "[analysis]") {
  for (const Method method : {Method::kAdams, Method::kExponential}) {
    Oscillator oscillator;
    oscillator.known_stiffness = 0.8;
    const auto integrator = make_integrator(oscillator, {.method = method, .relative_tolerance = 1e-8});
    integrator->start(0.0, std::array{1.0, 0.0}, 3.0);
    std::vector<double> y(2);
    int num_steps = 0;
    Integrator::StepResult result{};
    do {
      const double before = integrator->time();
      result = integrator->step(0.01);
      ++num_steps;
      CHECK(integrator->time() - before <= 0.01 * (1.0 + 1e-12));
      for (const double share : {0.0, 0.3, 0.5, 1.0}) {
        const double time = before + share * (integrator->time() - before);
        integrator->interpolate(time, y);
        CHECK(y[0] == Approx(std::cos(time)).margin(1e-6));
        CHECK(y[1] == Approx(-std::sin(time)).margin(1e-6));
      }
    } while (result == Integrator::StepResult::kStepped);
    CHECK(result == Integrator::StepResult::kEnded);
    CHECK(num_steps >= 300);
    CHECK(integrator->statistics().steps == num_steps);
  }
}

TEST_CASE("Switches are located where they are zero", "[analysis]") {
  for (const Method method : {Method::kAdams, Method::kBdf, Method::kExponential}) {
    Oscillator oscillator;
    oscillator.has_switches = true;
    oscillator.known_stiffness = 0.8;
    const auto integrator = make_integrator(oscillator, {.method = method, .relative_tolerance = 1e-10});
    integrator->start(0.0, std::array{1.0, 0.0}, 6.0);
    std::vector<double> times;
    while (true) {
      const Integrator::StepResult result = integrator->step(kInfinity);
      if (result == Integrator::StepResult::kEnded) break;
      if (result != Integrator::StepResult::kSwitched) continue;
      times.push_back(integrator->time());
      oscillator.above = times.size() == 3;
      oscillator.is_late = times.size() > 1;
      const std::vector<double> y(integrator->y().begin(), integrator->y().end());
      integrator->start(integrator->time(), y, 6.0);
    }
    REQUIRE(times.size() == 3);
    // cos t = ½ at π/3 and 5π/3
    CHECK(times[0] == Approx(std::acos(0.5)).margin(1e-7));
    CHECK(times[1] == Approx(2.0).margin(1e-11));
    CHECK(times[2] == Approx(5.0 * std::acos(0.5)).margin(1e-7));
    CHECK(integrator->statistics().restarts == 3);
  }
}

TEST_CASE("Where the equations cannot be evaluated the run stops with the time and the reason",
          "[analysis]") {
  for (const Method method : {Method::kAdams, Method::kExponential}) {
    Oscillator oscillator;
    oscillator.wall = 1.5;
    const auto integrator = make_integrator(oscillator, {.method = method, .relative_tolerance = 1e-6});
    integrator->start(0.0, std::array{1.0, 0.0}, 3.0);
    const auto run = [&] {
      while (integrator->step(0.1) == Integrator::StepResult::kStepped) {
      }
    };
    CHECK_THROWS_AS(run(), support::NumericalError);
    CHECK_THROWS_WITH(run(),
                      Contains("integration stopped at t = 1.") && Contains("look at forces and positions"));
  }
}

TEST_CASE("A tolerance below rounding is reported as such", "[analysis]") {
  Oscillator oscillator;
  const auto integrator =
      make_integrator(oscillator, {.method = Method::kAdams, .relative_tolerance = 1e-18});
  integrator->start(0.0, std::array{1.0, 0.0}, 10.0);
  const auto run = [&] {
    while (integrator->step(kInfinity) == Integrator::StepResult::kStepped) {
    }
  };
  CHECK_THROWS_WITH(run(), Contains("finer than rounding") && Contains("try a larger one"));
}

TEST_CASE("Vibration costs the exponential method as much far from the origin as at it", "[analysis]") {
  // A body that moves freely along x carries two oscillators that are coupled to it by inertia. The linear
  // part that is given is not exact, because the stiffness is that of a pendulum under its weight.
  class Carrier final : public dynamics::OdeSystem {
   public:
    const Eigen::Matrix3d mass{{1.0, 0.3, 0.27}, {0.3, 1.0, 0.13}, {0.27, 0.13, 1.0}};
    const Eigen::Vector3d stiffness{0.0, 1.1e6, 3.3e7};
    long num_evaluations = 0;

    int size() const override { return 6; }
    int num_freedoms() const override { return 3; }
    bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) override {
      ++num_evaluations;
      const Eigen::Vector3d q(y[0], y[1], y[2]), push(std::sin(30.0 * time), 0.0, 0.0);
      const Eigen::Vector3d v_dot = mass.inverse() * (push - stiffness.cwiseProduct(q));
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        y_dot[k] = y[k + 3];
        y_dot[k + 3] = v_dot[i];
      }
      return true;
    }
    int num_switches() const override { return 0; }
    bool calc_switches(double /*time*/, std::span<const double> /*y*/,
                       std::span<double> /*values*/) override {
      return true;
    }
    void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
      std::fill(scales.begin(), scales.end(), 1.0);
    }
    bool calc_small_motion(double /*time*/, std::span<const double> /*y*/,
                           dynamics::SmallMotion& motion) override {
      motion.mass = mass;
      motion.damping = Eigen::Matrix3d::Zero();
      motion.stiffness = (stiffness + Eigen::Vector3d(50.0, 0.0, 0.0)).asDiagonal();
      return true;
    }
  };
  const auto count = [](double place) {
    Carrier system;
    const auto integrator = make_integrator(system, {.relative_tolerance = 1e-9});
    integrator->start(0.0, std::array{place, 1e-3, 1e-3, 7.0, 0.0, 0.0}, 1.0);
    while (integrator->step(kInfinity) != Integrator::StepResult::kEnded) {
    }
    return system.num_evaluations;
  };
  const long at_origin = count(0.0), far = count(1e9);
  CAPTURE(at_origin, far);
  CHECK(5 * far < 6 * at_origin);
}

TEST_CASE("The exponential method needs few steps for motion of the given linear part", "[analysis]") {
  // 10 000 rad/s for 10 s: 16 000 periods.
  class Stiff final : public dynamics::OdeSystem {
   public:
    int size() const override { return 2; }
    int num_freedoms() const override { return 1; }
    bool calc_derivative(double /*time*/, std::span<const double> y, std::span<double> y_dot) override {
      y_dot[0] = y[1];
      y_dot[1] = -1e8 * y[0];
      return true;
    }
    int num_switches() const override { return 0; }
    bool calc_switches(double, std::span<const double>, std::span<double>) override { return true; }
    void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
      scales[0] = 1.0;
      scales[1] = 1e4;
    }
    bool calc_small_motion(double, std::span<const double>, dynamics::SmallMotion& motion) override {
      motion.mass = Eigen::MatrixXd::Identity(1, 1);
      motion.damping = Eigen::MatrixXd::Zero(1, 1);
      motion.stiffness = 1e8 * Eigen::MatrixXd::Identity(1, 1);
      return true;
    }
  } stiff;
  const auto integrator =
      make_integrator(stiff, {.method = Method::kExponential, .relative_tolerance = 1e-8});
  integrator->start(0.0, std::array{1.0, 0.0}, 10.0);
  while (integrator->step(kInfinity) != Integrator::StepResult::kEnded) {
  }
  CHECK(integrator->statistics().steps < 40);
  CHECK(integrator->y()[0] == Approx(std::cos(1e5)).margin(1e-9));  // the phase is known to 1e5 · 1e-16
  CHECK(integrator->y()[1] == Approx(-1e4 * std::sin(1e5)).margin(1e-5));
}

TEST_CASE("The exponential method notices damping that became stiff", "[analysis]") {
  // A mass of 1 kg on a spring of 1000 N/m slides on a belt that moves at 0.1 m/s without friction, until it
  // sticks to it: then the force is 2e5 N·s/m times the difference of their speeds. While it sticks, its
  // speed lags by k x/c, up to terms in 1/c². The 3 s are 600 000 times as long as 1/c.
  static constexpr double kBelt = 0.1, kStiffness = 1e3;
  class Sticking final : public dynamics::OdeSystem {
   public:
    double damping = 0.0;

    int size() const override { return 2; }
    int num_freedoms() const override { return 1; }
    bool calc_derivative(double /*time*/, std::span<const double> y, std::span<double> y_dot) override {
      y_dot[0] = y[1];
      y_dot[1] = -kStiffness * y[0] - damping * (y[1] - kBelt);
      return true;
    }
    int num_switches() const override { return 0; }
    bool calc_switches(double, std::span<const double>, std::span<double>) override { return true; }
    void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
      scales[0] = scales[1] = 0.01;
    }
    bool calc_small_motion(double, std::span<const double>, dynamics::SmallMotion& motion) override {
      motion.mass = Eigen::MatrixXd::Identity(1, 1);
      motion.damping = damping * Eigen::MatrixXd::Identity(1, 1);
      motion.stiffness = kStiffness * Eigen::MatrixXd::Identity(1, 1);
      return true;
    }
  } mass;
  const auto integrator = make_integrator(mass, {.method = Method::kExponential, .relative_tolerance = 1e-6});
  const auto run_to = [&](double from, std::array<double, 2> y, double end) {
    integrator->start(from, y, end);
    while (integrator->step(kInfinity) != Integrator::StepResult::kEnded) {
    }
    return std::array{integrator->y()[0], integrator->y()[1]};
  };
  const std::array<double, 2> touching = run_to(0.0, {0.0, kBelt}, 0.1);
  mass.damping = 2e5;
  const std::array<double, 2> end = run_to(0.1, touching, 3.1);
  CHECK(integrator->statistics().steps < 200);
  const double rate = kStiffness / mass.damping, limit = kBelt / rate;
  CHECK(end[0] == Approx(limit + (touching[0] - limit) * std::exp(-rate * 3.0)).margin(1e-6));
  CHECK(end[1] == Approx(kBelt - rate * end[0]).margin(1e-6));
}
