#include "dynamics/functions/time_function.h"

#include <array>
#include <cmath>
#include <vector>

#include "tests/catch.h"

using namespace sprung;
using dynamics::TimeFunction;

namespace {

constexpr std::array kTimes{0.2, 0.5, 0.9, 1.6}, kValues{1.0, -2.0, 0.5, 0.7};

}  // namespace

TEST_CASE("Rate and acceleration are the derivatives of the value", "[forces]") {
  const std::array functions{
      TimeFunction(3.0),
      TimeFunction::polynomial({1.0, -2.0, 0.5, 4.0}),
      TimeFunction::harmonic({.mean = 0.1, .amplitude = 0.7, .frequency_hz = 0.8, .phase = 1.1}),
      TimeFunction::spline(kTimes, kValues),
      TimeFunction::lines(kTimes, kValues),
      TimeFunction::smooth_step({.before = -1.0, .after = 2.0, .start = 0.3, .end = 1.5})};
  constexpr double h = 1e-3;  // s; errors of about 1e-11 and 1e-9
  for (std::size_t i = 0; i < functions.size(); ++i) {
    const TimeFunction& f = functions[i];
    for (const double t : {0.1, 0.35, 0.77, 1.31, 1.9}) {
      CAPTURE(i, t);
      const double rate =
          (8.0 * (f.value(t + h) - f.value(t - h)) - (f.value(t + 2 * h) - f.value(t - 2 * h))) / (12.0 * h);
      const double acceleration =
          (8.0 * (f.rate(t + h) - f.rate(t - h)) - (f.rate(t + 2 * h) - f.rate(t - 2 * h))) / (12.0 * h);
      CHECK(f.rate(t) == Approx(rate).margin(1e-9));
      CHECK(f.acceleration(t) == Approx(acceleration).margin(1e-8));
    }
  }
}

TEST_CASE("Functions of time have the values they are given", "[forces]") {
  CHECK(TimeFunction(3.0).value(7.0) == 3.0);
  CHECK(TimeFunction::polynomial({1.0, 2.0, 3.0}).value(2.0) == 17.0);
  // A quarter of a period after the phase's zero.
  CHECK(TimeFunction::harmonic({.mean = 1.0, .amplitude = 2.0, .frequency_hz = 0.25, .phase = 0.0})
            .value(1.0) == Approx(3.0).epsilon(1e-15));
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    CHECK(TimeFunction::lines(kTimes, kValues).value(kTimes[i]) == Approx(kValues[i]).epsilon(1e-14));
    CHECK(TimeFunction::spline(kTimes, kValues).value(kTimes[i]) == Approx(kValues[i]).epsilon(1e-14));
  }
  CHECK(TimeFunction::lines(kTimes, kValues).value(0.35) == Approx(-0.5).epsilon(1e-14));
  const TimeFunction step =
      TimeFunction::smooth_step({.before = -1.0, .after = 2.0, .start = 0.3, .end = 1.5});
  CHECK(step.value(0.9) == Approx(0.5).epsilon(1e-14));  // half way, by symmetry
}

TEST_CASE("Tables and steps are constant outside; splines and steps start and end with zero velocity",
          "[forces]") {
  const TimeFunction lines = TimeFunction::lines(kTimes, kValues),
                     spline = TimeFunction::spline(kTimes, kValues);
  for (const TimeFunction* f : {&lines, &spline}) {
    CHECK(f->value(-5.0) == 1.0);
    CHECK(f->value(9.0) == Approx(0.7).epsilon(1e-14));
    CHECK(f->rate(9.0) == 0.0);
  }
  CHECK(std::abs(spline.rate(0.2)) < 1e-13);
  CHECK(std::abs(spline.rate(1.6 - 1e-12)) < 1e-9);
  const TimeFunction step =
      TimeFunction::smooth_step({.before = -1.0, .after = 2.0, .start = 0.3, .end = 1.5});
  for (const double t : {0.3, 1.5}) {
    CHECK(std::abs(step.rate(t - 1e-9)) < 1e-12);
    CHECK(std::abs(step.rate(t + 1e-9)) < 1e-12);
    CHECK(std::abs(step.acceleration(t - 1e-9)) < 1e-6);
    CHECK(std::abs(step.acceleration(t + 1e-9)) < 1e-6);
  }
  CHECK(step.value(0.0) == -1.0);
  CHECK(step.value(4.0) == 2.0);
}

TEST_CASE("Derivatives jump at breaks; at a break the function has the derivatives of the following piece",
          "[forces]") {
  const TimeFunction lines = TimeFunction::lines(kTimes, kValues);
  CHECK(std::vector<double>(lines.breaks().begin(), lines.breaks().end()) ==
        std::vector<double>(kTimes.begin(), kTimes.end()));
  CHECK(lines.rate(0.5) == Approx(2.5 / 0.4));
  CHECK(lines.rate(std::nextafter(0.5, 0.0)) == Approx(-10.0));
  CHECK(TimeFunction::spline(kTimes, kValues).breaks().size() == 2);
  CHECK(TimeFunction::polynomial({1.0, 2.0}).breaks().empty());
  CHECK(TimeFunction(2.0).is_constant());
  CHECK_FALSE(lines.is_constant());
  CHECK(TimeFunction::harmonic({.amplitude = 1.0, .frequency_hz = 4.0}).details().shortest() == 0.125 / 4.0);
}

TEST_CASE("Impossible functions of time are refused", "[forces]") {
  CHECK_THROWS_WITH(TimeFunction::smooth_step({.before = 0.0, .after = 1.0, .start = 2.0, .end = 2.0}),
                    "TimeFunction::smooth_step: end must come after start, got 2 s and 2 s");
  CHECK_THROWS_WITH(TimeFunction::harmonic({.amplitude = 1.0}),
                    "TimeFunction::harmonic: frequency_hz must be > 0 Hz, got 0");
}
