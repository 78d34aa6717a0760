#include "dynamics/analysis/cvode_integrator.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/catch.h"
#include "tools/support/numerical_error.h"

using namespace sprung;
using Catch::Matchers::Contains;
using dynamics::CvodeIntegrator;

namespace {

// ẍ = −x with switches at x = ½ (falling or rising) and at t = 2; beyond `wall` it cannot be evaluated.
class Oscillator final : public dynamics::OdeSystem {
 public:
  double wall = std::numeric_limits<double>::infinity();
  bool has_switches = false;

  int size() const override { return 2; }
  bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) override {
    if (time > wall) return false;
    y_dot[0] = y[1];
    y_dot[1] = -y[0];
    return true;
  }
  int num_switches() const override { return has_switches ? 2 : 0; }
  bool calc_switches(double time, std::span<const double> y, std::span<double> values) override {
    values[0] = y[0] - 0.5;
    values[1] = time - 2.0;
    return true;
  }
  void calc_error_scales(std::span<const double> /*y*/, std::span<double> scales) const override {
    scales[0] = scales[1] = 1.0;
  }
};

double error_at_end(CvodeIntegrator::Method method, double tolerance) {
  Oscillator oscillator;
  CvodeIntegrator integrator(oscillator, {.method = method, .relative_tolerance = tolerance});
  const std::array start{1.0, 0.0};
  integrator.start(0.0, start, 10.0);
  while (integrator.step(std::numeric_limits<double>::infinity()) != CvodeIntegrator::StepResult::kEnded) {
  }
  CHECK(integrator.time() == 10.0);
  return std::hypot(integrator.y()[0] - std::cos(10.0), integrator.y()[1] + std::sin(10.0));
}

}  // namespace

TEST_CASE("The harmonic oscillator's error follows the tolerance, with either method", "[analysis]") {
  for (const auto method : {CvodeIntegrator::Method::kAdams, CvodeIntegrator::Method::kBdf}) {
    double last = 1.0;
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const double error = error_at_end(method, tolerance);
      CHECK(error < 300.0 * tolerance);
      CHECK(error < last);
      last = error;
    }
  }
}

TEST_CASE("Steps keep to the longest that is allowed, and the solution is known within them", "[analysis]") {
  Oscillator oscillator;
  CvodeIntegrator integrator(oscillator, {.relative_tolerance = 1e-8});
  integrator.start(0.0, std::array{1.0, 0.0}, 3.0);
  std::vector<double> y(2);
  int num_steps = 0;
  CvodeIntegrator::StepResult result{};
  do {
    result = integrator.step(0.01);
    ++num_steps;
    CHECK(integrator.time() - integrator.step_start() <= 0.01 * (1.0 + 1e-12));
    const double middle = 0.5 * (integrator.step_start() + integrator.time());
    integrator.interpolate(middle, y);
    CHECK(y[0] == Approx(std::cos(middle)).margin(1e-6));
  } while (result == CvodeIntegrator::StepResult::kStepped);
  CHECK(result == CvodeIntegrator::StepResult::kEnded);
  CHECK(num_steps >= 300);
  CHECK(integrator.statistics().steps == num_steps);
}

TEST_CASE("Switches are located where they are zero", "[analysis]") {
  Oscillator oscillator;
  oscillator.has_switches = true;
  CvodeIntegrator integrator(oscillator, {.relative_tolerance = 1e-10});
  integrator.start(0.0, std::array{1.0, 0.0}, 6.0);
  std::vector<double> times;
  std::vector<int> which;
  std::vector<double> y(2);
  while (true) {
    const CvodeIntegrator::StepResult result = integrator.step(std::numeric_limits<double>::infinity());
    if (result == CvodeIntegrator::StepResult::kEnded) break;
    if (result != CvodeIntegrator::StepResult::kSwitched) continue;
    REQUIRE(integrator.switched().size() == 1);
    times.push_back(integrator.time());
    which.push_back(integrator.switched()[0]);
    y.assign(integrator.y().begin(), integrator.y().end());
    integrator.start(integrator.time(), y, 6.0);
  }
  REQUIRE(times.size() == 3);
  CHECK(which == std::vector<int>{0, 1, 0});
  // cos t = ½ at π/3 and 5π/3
  CHECK(times[0] == Approx(std::acos(0.5)).margin(1e-8));
  CHECK(times[1] == Approx(2.0).margin(1e-12));
  CHECK(times[2] == Approx(5.0 * std::acos(0.5)).margin(1e-8));
  CHECK(integrator.statistics().restarts == 3);
}

TEST_CASE("Where the equations cannot be evaluated the run stops with the time and the reason",
          "[analysis]") {
  Oscillator oscillator;
  oscillator.wall = 1.5;
  CvodeIntegrator integrator(oscillator, {.relative_tolerance = 1e-6});
  integrator.start(0.0, std::array{1.0, 0.0}, 3.0);
  const auto run = [&] {
    while (integrator.step(0.1) == CvodeIntegrator::StepResult::kStepped) {
    }
  };
  CHECK_THROWS_AS(run(), support::NumericalError);
  CHECK_THROWS_WITH(
      run(), Contains("integration stopped at t = 1.") && Contains("try a smaller relative tolerance"));
}
