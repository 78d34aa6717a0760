#include "dynamics/functions/piecewise_polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/random_numbers.h"

using namespace sprung;
using dynamics::PiecewisePolynomial;

namespace {

// The truck's suspension spring, N over m.
PiecewisePolynomial suspension() {
  PiecewisePolynomial spring(std::vector<double>{0.0, 4.67e5, 1.49e6 / 2.0});
  spring.continue_straight(0.15, 6.91e6, false);
  return spring;
}

// A law of five pieces, curved and straight, continuous.
PiecewisePolynomial many_pieces() {
  PiecewisePolynomial law = PiecewisePolynomial::clamped_spline(std::vector<double>{-1.0, -0.2, 0.3, 1.1},
                                                                std::vector<double>{0.4, -0.7, 0.9, 0.2});
  law.continue_straight(-0.8, 3.0, true);
  law.continue_straight(0.9, -2.0, false);
  return law;
}

double central_difference(const auto& f, double x) {
  constexpr double kStep = 1e-5;
  return (f(x + kStep) - f(x - kStep)) / (2.0 * kStep);
}

}  // namespace

TEST_CASE("A polynomial with its slope and its integral from zero", "[forces]") {
  const PiecewisePolynomial f(std::vector<double>{2.0, -3.0, 0.5});
  CHECK(f.value(4.0) == 2.0 - 12.0 + 8.0);
  CHECK(f.slope(4.0) == -3.0 + 4.0);
  CHECK(f.integral(4.0) == Approx(8.0 - 24.0 + 0.5 * 64.0 / 3.0).epsilon(1e-15));
  CHECK(f.integral(0.0) == 0.0);
  CHECK(f.breaks().empty());
  CHECK(PiecewisePolynomial().value(3.0) == 0.0);
  CHECK(PiecewisePolynomial(std::vector<double>{}).value(3.0) == 0.0);
}

TEST_CASE("The truck's spring with its bump stop", "[forces]") {
  const PiecewisePolynomial spring = suspension();
  // F(0.15) = 4.67e5 · 0.15 + 1.49e6 · 0.15²/2 and the tangent there, from the vehicle's table of data
  CHECK(spring.value(0.15) == Approx(86812.5).epsilon(1e-14));
  CHECK(spring.value(0.15 - 1e-12) == Approx(86812.5).epsilon(1e-9));
  CHECK(spring.slope(0.15 - 1e-12) == Approx(6.905e5).epsilon(1e-9));
  CHECK(spring.slope(0.15) == 6.91e6);
  CHECK(spring.value(0.17) == Approx(86812.5 + 0.02 * 6.91e6).epsilon(1e-14));
  CHECK(spring.value(-0.03) == Approx(-0.03 * 4.67e5 + 0.0009 * 1.49e6 / 2.0).epsilon(1e-14));
  // Energy up to 0.17 m: k0 d²/2 + k1 d³/6 to the stop, then a trapezium
  const double to_stop = 4.67e5 * 0.0225 / 2.0 + 1.49e6 * 0.003375 / 6.0;
  CHECK(spring.integral(0.17) == Approx(to_stop + 0.02 * (86812.5 + 0.5 * 0.02 * 6.91e6)).epsilon(1e-14));
  REQUIRE(spring.breaks().size() == 1);
  CHECK(spring.breaks()[0] == 0.15);
}

TEST_CASE("Value, slope and integral of many pieces fit together", "[forces]") {
  const PiecewisePolynomial law = many_pieces();
  REQUIRE(law.breaks().size() == 4);
  test::RandomNumbers random(3);
  for (int i = 0; i < 200; ++i) {
    const double x = random.between(-2.0, 2.0);
    bool near_break = false;
    for (const double at : law.breaks()) near_break |= std::abs(x - at) < 1e-4;
    if (near_break) continue;
    CHECK(central_difference([&](double s) { return law.integral(s); }, x) ==
          Approx(law.value(x)).margin(1e-9));
    CHECK(central_difference([&](double s) { return law.value(s); }, x) == Approx(law.slope(x)).margin(1e-8));
    CHECK(central_difference([&](double s) { return law.slope(s); }, x) ==
          Approx(law.curvature(x)).margin(1e-7));
  }
  for (const double at : law.breaks()) {
    CHECK(law.value(std::nextafter(at, -2.0)) == Approx(law.value(at)).margin(1e-14));
    CHECK(law.integral(std::nextafter(at, -2.0)) == Approx(law.integral(at)).margin(1e-14));
  }
  CHECK(law.integral(0.0) == Approx(0.0).margin(1e-16));
}

TEST_CASE("Straight lines through points continue beyond the ends", "[forces]") {
  // The truck's damper: 17575 N·s/m in rebound, 5480 N·s/m in compression
  const PiecewisePolynomial damper =
      PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0}, std::array{-17575.0, 0.0, 5480.0});
  CHECK(damper.value(-3.0) == Approx(-3.0 * 17575.0).epsilon(1e-14));
  CHECK(damper.value(2.5) == Approx(2.5 * 5480.0).epsilon(1e-14));
  CHECK(damper.slope(0.0) == 5480.0);
  CHECK(damper.slope(-1e-9) == 17575.0);
  CHECK(damper.integral(-2.0) == Approx(0.5 * 17575.0 * 4.0).epsilon(1e-14));
}

TEST_CASE("A law is clipped where it is zero", "[forces]") {
  PiecewisePolynomial f(std::vector<double>{0.0, 2.0, 1.0});
  f.continue_straight(0.0, 0.0, true);
  CHECK(f.value(-3.0) == 0.0);
  CHECK(f.integral(-3.0) == 0.0);
  CHECK(f.value(2.0) == 8.0);
}

TEST_CASE("Stops replace what lies beyond them", "[forces]") {
  PiecewisePolynomial f =
      PiecewisePolynomial::through_points(std::array{0.0, 1.0, 2.0, 3.0}, std::array{0.0, 1.0, 5.0, 6.0});
  f.continue_straight(1.5, 10.0, false);
  CHECK(f.value(1.25) == 2.0);
  CHECK(f.value(2.5) == 3.0 + 10.0);
  f.continue_straight(0.5, 0.25, true);
  CHECK(f.value(-0.5) == 0.5 - 0.25);
  CHECK(f.value(0.75) == 0.75);
  CHECK(f.value(2.5) == 13.0);
  REQUIRE(f.breaks().size() == 3);
  // At a point of the table, from either side
  f.continue_straight(1.0, -1.0, false);
  CHECK(f.value(2.0) == 0.0);
  CHECK(f.value(0.75) == 0.75);
  // By areas: 0.375 + 0.25 x to 0.5, x to 1, 2 − x to 2
  CHECK(f.integral(2.0) == Approx((0.375 * 0.5 + 0.125 * 0.25) + 0.375 + 0.5).margin(1e-14));
}

TEST_CASE("The clamped spline reproduces a cubic that is level at both ends", "[forces]") {
  const auto cubic = [](double x) { return 2.0 + 5.0 * x * x * (3.0 - 2.0 * x); };  // level at 0 and 1
  const std::vector<double> x{0.0, 0.13, 0.2, 0.55, 0.8, 1.0};
  std::vector<double> y;
  for (const double at : x) y.push_back(cubic(at));
  const PiecewisePolynomial spline = PiecewisePolynomial::clamped_spline(x, y);
  for (double at = 0.0; at <= 1.0; at += 0.01) {
    CHECK(spline.value(at) == Approx(cubic(at)).epsilon(1e-14));
    CHECK(spline.slope(at) == Approx(30.0 * at * (1.0 - at)).margin(1e-12));
  }
}

TEST_CASE("The clamped spline passes through its points with two continuous derivatives, level at its ends",
          "[forces]") {
  const std::vector<double> x{-1.0, -0.6, 0.1, 0.3, 1.2, 1.5}, y{0.0, 1.0, -2.0, 0.5, 0.7, -1.0};
  const PiecewisePolynomial spline = PiecewisePolynomial::clamped_spline(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(spline.value(x[i]) == Approx(y[i]).margin(1e-14));
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double left = std::nextafter(x[i], -10.0);
    CHECK(spline.slope(left) == Approx(spline.slope(x[i])).margin(1e-12));
    CHECK(spline.curvature(left) == Approx(spline.curvature(x[i])).margin(1e-11));
  }
  CHECK(spline.slope(-1.0) == Approx(0.0).margin(1e-14));
  CHECK(spline.slope(1.5) == Approx(0.0).margin(1e-13));
  const PiecewisePolynomial two =
      PiecewisePolynomial::clamped_spline(std::array{0.0, 2.0}, std::array{1.0, 3.0});
  CHECK(two.value(1.0) == 2.0);  // the cubic smooth step
  CHECK(two.value(0.5) == Approx(1.0 + 2.0 * 0.0625 * 2.5).epsilon(1e-14));
}

TEST_CASE("The clamped spline converges with the fourth power of the spacing", "[forces]") {
  // [de Boor 2001], ch. V: complete cubic spline interpolation, error ≤ 5/384 h⁴ max|f⁗|
  const auto largest_error = [](int num_pieces) {
    std::vector<double> x, y;
    for (int i = 0; i <= num_pieces; ++i) {
      x.push_back(static_cast<double>(i) / num_pieces);
      y.push_back(std::cos(std::numbers::pi * x.back()));
    }
    const PiecewisePolynomial spline = PiecewisePolynomial::clamped_spline(x, y);
    double error = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      error = std::max(error, std::abs(spline.value(1e-3 * i) - std::cos(std::numbers::pi * 1e-3 * i)));
    }
    return error;
  };
  const double coarse = largest_error(10), fine = largest_error(20);
  CHECK(std::log2(coarse / fine) == Approx(4.0).margin(0.1));
  CHECK(coarse < 1.01 * 5.0 / 384.0 * std::pow(0.1 * std::numbers::pi, 4));
}

TEST_CASE("Points must be at least two and ascend", "[forces]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto make : {&PiecewisePolynomial::through_points, &PiecewisePolynomial::clamped_spline}) {
    CHECK_THROWS_WITH(make(std::array{0.0}, std::array{0.0}), Contains("at least 2 points"));
    CHECK_THROWS_WITH(make(std::array{0.0, 1.0}, std::array{0.0}), Contains("at least 2 points"));
    CHECK_THROWS_WITH(make(std::array{0.0, 0.0}, std::array{0.0, 1.0}),
                      Contains("x must ascend, got 0 after 0"));
    CHECK_THROWS_WITH(make(std::array{0.0, nan}, std::array{0.0, 1.0}), Contains("x must ascend"));
  }
}

TEST_CASE("A function of many pieces has the same value whatever was asked before", "[forces]") {
  // Straight lines through (k², k): the value at x is k + (x − k²)/(2k + 1), k the whole part of √x.
  constexpr int kPoints = 2000;
  std::vector<double> x, y;
  for (int k = 0; k < kPoints; ++k) {
    x.push_back(static_cast<double>(k) * k);
    y.push_back(k);
  }
  const PiecewisePolynomial f = PiecewisePolynomial::through_points(x, y);
  const auto expected = [](double at) {
    const double k = std::min(std::floor(std::sqrt(at)), kPoints - 2.0);
    return k + (at - k * k) / (2.0 * k + 1.0);
  };
  for (double at = 0.0; at < 5000.0; at += 0.7) CHECK(f.value(at) == Approx(expected(at)).epsilon(1e-14));
  for (double at = 5000.0; at > 0.0; at -= 0.7) CHECK(f.value(at) == Approx(expected(at)).epsilon(1e-14));
  test::RandomNumbers random(11);
  for (int i = 0; i < 2000; ++i) {
    const double at = random.between(0.0, 4.2e6);
    CHECK(f.value(at) == Approx(expected(at)).epsilon(1e-13));
  }
  // At a break the piece that begins is used, from both sides.
  for (const double from : {0.0, 5000.0}) {
    f.value(from);
    CHECK(f.slope(100.0) == Approx(1.0 / 21.0).epsilon(1e-14));
    f.value(from);
    CHECK(f.slope(std::nextafter(100.0, 0.0)) == Approx(1.0 / 19.0).epsilon(1e-14));
  }
}

TEST_CASE("A piece is used slightly beyond its ends", "[forces]") {
  const PiecewisePolynomial spring = suspension();
  constexpr double kBand = 1e-3;
  // Its own formula beyond the break
  CHECK(spring.value_in_piece(0, 0.2) == Approx(4.67e5 * 0.2 + 1.49e6 * 0.02).epsilon(1e-14));
  CHECK(spring.value_in_piece(1, 0.1) == Approx(86812.5 - 0.05 * 6.91e6).epsilon(1e-14));
  CHECK(spring.choose_piece(0, 0.1504, kBand) == 0);
  CHECK(spring.choose_piece(0, 0.1506, kBand) == 1);
  CHECK(spring.choose_piece(1, 0.1496, kBand) == 1);
  CHECK(spring.choose_piece(1, 0.1494, kBand) == 0);
  // A switch function is zero a whole band beyond the break, where the new piece is certainly chosen
  std::array<double, 2> values{};
  spring.calc_piece_switches(0, 0.1509, kBand, values);
  CHECK(values[0] > 0.0);
  CHECK(values[1] > 0.0);
  spring.calc_piece_switches(0, 0.1511, kBand, values);
  CHECK(values[1] < 0.0);
  spring.calc_piece_switches(1, 0.1489, kBand, values);
  CHECK(values[0] < 0.0);
  CHECK(values[1] > 0.0);
}
