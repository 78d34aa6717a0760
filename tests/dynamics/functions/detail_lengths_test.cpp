#include "dynamics/functions/detail_lengths.h"

#include <array>
#include <limits>
#include <vector>

#include "dynamics/functions/time_function.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::DetailLengths;
using dynamics::TimeFunction;

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("Two close samples limit the steps near them only", "[functions]") {
  // 0.4 of the way to a shorter interval is the longest step, until the interval itself is longer.
  const DetailLengths details = DetailLengths::between(std::vector{0.0, 0.1, 0.2, 0.2 + 1e-6, 0.3});
  CHECK(details.shortest() == Approx(1e-6));
  CHECK(details.calc_longest_step(0.0) == Approx(0.4 * 0.2));
  CHECK(details.calc_longest_step(0.1) == Approx(0.4 * 0.1));
  CHECK(details.calc_longest_step(0.2 - 1e-6) == Approx(1e-6));
  CHECK(details.calc_longest_step(0.2) == Approx(1e-6));
  CHECK(details.calc_longest_step(0.2 + 2e-6) == Approx(0.1 - 1e-6));
  CHECK(details.calc_longest_step(0.3) == kForever);
}

TEST_CASE("A step that is 2.3 times as long as allowed still ends before a shorter detail", "[functions]") {
  const DetailLengths details = DetailLengths::between(std::vector{0.0, 1.0, 1.0 + 1e-7, 2.0});
  double time = 0.0;
  while (1.0 - time > 1e-6) {
    time += 2.3 * details.calc_longest_step(time);
    REQUIRE(time < 1.0);
  }
}

TEST_CASE("Equal samples allow the same step everywhere, and none before and after", "[functions]") {
  std::vector<double> times;
  for (int i = 0; i <= 1000; ++i) times.push_back(5.0 + 0.001 * i);
  const DetailLengths details = DetailLengths::between(times);
  for (const double time : {5.0, 5.0004, 5.5, 5.9999})
    CHECK(details.calc_longest_step(time) == Approx(0.001));
  CHECK(details.calc_longest_step(4.0) == Approx(0.4));
  CHECK(details.calc_longest_step(6.1) == kForever);
}

TEST_CASE("Of two functions the shorter details count, of pieces those of the piece", "[functions]") {
  const DetailLengths coarse = DetailLengths::between(std::vector{0.0, 1.0, 2.0}), fine(0.25);
  const DetailLengths both = DetailLengths::shorter(coarse, fine);
  CHECK(both.calc_longest_step(-3.0) == 0.25);
  CHECK(both.calc_longest_step(0.5) == 0.25);
  const DetailLengths joined = DetailLengths::join(std::array{1.5}, std::array{coarse, fine});
  CHECK(joined.calc_longest_step(0.0) == Approx(0.4 * 1.5));
  CHECK(joined.calc_longest_step(1.5) == 0.25);

  // Of 1/(8 · 5 Hz) while it lasts.
  const TimeFunction burst = TimeFunction::pieces(
      std::array{1.0, 2.0},
      std::array{TimeFunction(0.0), TimeFunction::harmonic({.amplitude = 1.0, .frequency_hz = 5.0}),
                 TimeFunction(0.0)});
  CHECK(burst.details().calc_longest_step(0.0) == Approx(0.4));
  CHECK(burst.details().calc_longest_step(1.2) == Approx(0.025));
  CHECK(burst.details().calc_longest_step(2.0) == kForever);
  CHECK(TimeFunction::sum(burst, TimeFunction(1.0)).details().calc_longest_step(2.5) == kForever);
}
