// Sums, products, pieces and jumps of functions of time.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamics/functions/time_function.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::TimeFunction;

namespace {

using std::numbers::pi;

constexpr std::array kTimes{0.2, 0.5, 0.9, 1.6}, kValues{1.0, -2.0, 0.5, 0.7};
constexpr std::array kPlaces{-0.3, 0.1, 0.35, 0.77, 1.31, 1.9};

std::vector<TimeFunction> make_functions() {
  return {TimeFunction(3.0),
          TimeFunction::polynomial({1.0, -2.0, 0.5}),
          TimeFunction::harmonic({.mean = 0.1, .amplitude = 0.7, .frequency_hz = 0.8, .phase = 1.1}),
          TimeFunction::harmonic({.amplitude = -0.4, .frequency_hz = 2.3, .phase = 0.2}),
          TimeFunction::spline(kTimes, kValues),
          TimeFunction::smooth_step({.before = -1.0, .after = 2.0, .start = 0.3, .end = 1.5})};
}

}  // namespace

TEST_CASE("Sums and products of functions of time follow the rules of the derivatives", "[forces]") {
  const std::vector<TimeFunction> functions = make_functions();
  for (std::size_t i = 0; i < functions.size(); ++i) {
    for (std::size_t k = 0; k < functions.size(); ++k) {
      const TimeFunction &a = functions[i], &b = functions[k];
      // Three factors: the third makes a product of what is a sum of oscillations already.
      const TimeFunction sum = TimeFunction::sum(a, b), pair = TimeFunction::product(a, b),
                         triple = TimeFunction::product(pair, functions[3]);
      for (const double t : kPlaces) {
        CAPTURE(i, k, t);
        const double f = a.value(t) * b.value(t);
        const double f_rate = a.rate(t) * b.value(t) + a.value(t) * b.rate(t);
        const double f_acceleration =
            a.acceleration(t) * b.value(t) + 2.0 * a.rate(t) * b.rate(t) + a.value(t) * b.acceleration(t);
        CHECK(sum.value(t) == Approx(a.value(t) + b.value(t)).margin(1e-13));
        CHECK(sum.rate(t) == Approx(a.rate(t) + b.rate(t)).margin(1e-12));
        CHECK(sum.acceleration(t) == Approx(a.acceleration(t) + b.acceleration(t)).margin(1e-10));
        CHECK(pair.value(t) == Approx(f).margin(1e-12));
        CHECK(pair.rate(t) == Approx(f_rate).margin(1e-11));
        CHECK(pair.acceleration(t) == Approx(f_acceleration).margin(1e-9));
        CHECK(triple.value(t) == Approx(f * functions[3].value(t)).margin(1e-12));
      }
    }
  }
}

TEST_CASE("A product of two oscillations is a sum of two; a square has a mean", "[forces]") {
  const TimeFunction a = TimeFunction::harmonic({.amplitude = 2.0, .frequency_hz = 5.0}),
                     b = TimeFunction::harmonic({.amplitude = 3.0, .frequency_hz = 7.0, .phase = 0.3});
  const TimeFunction beat = TimeFunction::product(a, b);
  REQUIRE(beat.oscillations().size() == 2);
  CHECK(beat.oscillations()[0].frequency_hz == Approx(2.0).epsilon(1e-15));
  CHECK(beat.oscillations()[1].frequency_hz == Approx(12.0).epsilon(1e-15));
  CHECK(beat.details().shortest() == Approx(0.125 / 12.0).epsilon(1e-15));
  CHECK(beat.value(0.17) ==
        Approx(6.0 * std::sin(10.0 * pi * 0.17) * std::sin(14.0 * pi * 0.17 + 0.3)).epsilon(1e-13));
  const TimeFunction square = TimeFunction::product(b, b);  // 9 (½ − ½ cos 2x)
  CHECK(square.oscillations().size() == 1);
  CHECK(square.polynomials().value(0.4) == Approx(4.5).epsilon(1e-14));
}

TEST_CASE("Pieces are each their own function, with breaks and jumps at their ends", "[forces]") {
  const std::vector<TimeFunction> functions = make_functions();
  const std::vector parts{functions[1], functions[2], functions[5]};
  constexpr std::array kEnds{0.4, 1.0};
  const TimeFunction f = TimeFunction::pieces(kEnds, parts);
  for (const double t : kPlaces) {
    CAPTURE(t);
    const TimeFunction& part = parts[t < 0.4 ? 0 : t < 1.0 ? 1 : 2];
    CHECK(f.value(t) == Approx(part.value(t)).epsilon(1e-13));
    CHECK(f.rate(t) == Approx(part.rate(t)).epsilon(1e-12));
    CHECK(f.acceleration(t) == Approx(part.acceleration(t)).epsilon(1e-11));
  }
  CHECK(f.value(0.4) == Approx(parts[1].value(0.4)).epsilon(1e-14));
  CHECK(f.value(std::nextafter(0.4, 0.0)) == Approx(parts[0].value(0.4)).epsilon(1e-14));
  // The break of the step at 0.3 lies in the time of another piece.
  CHECK(std::vector<double>(f.breaks().begin(), f.breaks().end()) == std::vector<double>{0.4, 1.0, 1.5});
}

TEST_CASE("Two points of equal time are a jump, with a value on either side", "[forces]") {
  const TimeFunction f = TimeFunction::lines(std::array{0.5, 0.5, 1.0, 1.0, 2.0, 2.0},
                                             std::array{1.0, 3.0, 4.0, -1.0, 2.0, 0.0});
  const auto before = [](double t) { return std::nextafter(t, -1.0); };
  CHECK(f.value(0.2) == 1.0);
  CHECK(f.value(before(0.5)) == 1.0);
  CHECK(f.value(0.5) == 3.0);
  CHECK(f.value(0.75) == Approx(3.5).epsilon(1e-15));
  CHECK(f.value(before(1.0)) == Approx(4.0).epsilon(1e-14));
  CHECK(f.value(1.0) == -1.0);
  CHECK(f.value(before(2.0)) == Approx(2.0).epsilon(1e-14));
  CHECK(f.value(2.0) == 0.0);
  CHECK(f.value(9.0) == 0.0);
  CHECK(f.breaks().size() == 3);
  // A single jump between two constants is not constant, although its rate is 0 on both sides.
  const TimeFunction one = TimeFunction::lines(std::array{1.0, 1.0}, std::array{0.0, 5.0});
  CHECK_FALSE(one.is_constant());
  CHECK(one.value(before(1.0)) == 0.0);
  CHECK(one.value(1.0) == 5.0);
  CHECK_THROWS_WITH(TimeFunction::lines(std::array{1.0, 1.0, 1.0}, std::array{0.0, 5.0, 2.0}),
                    "TimeFunction::lines: times must ascend, and no three be equal, got 1 s after 1 s");
}

TEST_CASE("Jumps of the value and of the rate are found, also where they are products of others",
          "[forces]") {
  constexpr std::array kEnds{1.0, 2.0};
  const TimeFunction window =
      TimeFunction::pieces(kEnds, std::array{TimeFunction(0.0), TimeFunction(1.0), TimeFunction(0.0)});
  REQUIRE(window.find_jump());
  CHECK(window.find_jump()->time == 1.0);
  CHECK(window.find_jump()->after == 1.0);
  // sin πt is 0 at both ends of the window, its slope is not; sin² πt has no slope there either.
  const TimeFunction wave = TimeFunction::harmonic({.amplitude = 1.0, .frequency_hz = 0.5});
  const TimeFunction cut = TimeFunction::product(window, wave);
  REQUIRE(cut.find_jump());
  CHECK(cut.find_jump()->is_rate);
  CHECK(cut.find_jump()->after == Approx(-pi).epsilon(1e-12));
  CHECK_FALSE(TimeFunction::product(cut, wave).find_jump());
  for (const TimeFunction& f : make_functions()) CHECK_FALSE(f.find_jump());
  CHECK(TimeFunction::lines(kTimes, kValues).find_jump()->is_rate);
}
