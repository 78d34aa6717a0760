#include "dynamics/functions/mean_slope.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/catch.h"

using namespace sprung;
using dynamics::calc_mean_slope;
using dynamics::PiecewisePolynomial;

namespace {

// E[F(v₀ + v) v]/σ² by the trapezoidal rule over ±9 σ.
double integrate_force(const PiecewisePolynomial& law, double sigma, double mean) {
  constexpr int kSteps = 360000;
  const double width = 18.0 * sigma / kSteps;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double v = -9.0 * sigma + i * width;
    sum += law.value(mean + v) * v * std::exp(-0.5 * v * v / (sigma * sigma));
  }
  return sum * width / (std::pow(sigma, 3) * std::sqrt(2.0 * std::numbers::pi));
}

}  // namespace

TEST_CASE("A law of two slopes has their mean, however large the motion is", "[forces]") {
  const auto law =
      PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0}, std::array{-3000.0, 0.0, 800.0});
  for (const double sigma : {1e-6, 0.02, 0.4, 50.0}) {
    CAPTURE(sigma);
    CHECK(calc_mean_slope(law, sigma) == Approx(1900.0).epsilon(1e-14));
  }
}

TEST_CASE("A symmetric law of two slopes has the first with the probability of its piece", "[forces]") {
  // 12 kN·s/m up to 0.05 m/s, then 18/19 kN·s/m: P(|v| < b) = erf(b/(σ√2)).
  const auto law = PiecewisePolynomial::through_points(std::array{-1.0, -0.05, 0.0, 0.05, 1.0},
                                                       std::array{-1500.0, -600.0, 0.0, 600.0, 1500.0});
  for (const double sigma : {0.01, 0.06, 0.5}) {
    CAPTURE(sigma);
    const double inside = std::erf(0.05 / (sigma * std::numbers::sqrt2));
    CHECK(calc_mean_slope(law, sigma) ==
          Approx(12000.0 * inside + 900.0 / 0.95 * (1.0 - inside)).epsilon(1e-13));
  }
  CHECK(calc_mean_slope(law, 1e-9) == Approx(12000.0).epsilon(1e-13));
}

TEST_CASE("The moments of a normal variable give the mean slopes of polynomials", "[forces]") {
  // E[v²] = σ², E[v⁴] = 3σ⁴: of a v + b v² + c v³ + d v⁵ the mean slope is a + 3cσ² + 15dσ⁴.
  const PiecewisePolynomial law({0.0, 2.0, 7.0, 0.5, 0.0, 0.3});
  const double s = 1.4;
  CHECK(calc_mean_slope(law, s) == Approx(2.0 + 1.5 * s * s + 4.5 * std::pow(s, 4)).epsilon(1e-13));
  // |v| v: E[2|v|] = 2σ√(2/π).
  const auto square = PiecewisePolynomial::from_pieces({0.0}, {{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}});
  CHECK(calc_mean_slope(square, s) == Approx(2.0 * s * std::sqrt(2.0 / std::numbers::pi)).epsilon(1e-13));
}

TEST_CASE("The mean slope is the integral of the force times the rate, for pieces anywhere", "[forces]") {
  const std::array x{-1.5, -0.3, 0.2, 0.7, 1.1}, y{-2.0, -1.0, 0.4, 0.5, 2.5};
  for (const PiecewisePolynomial& law :
       {PiecewisePolynomial::through_points(x, y), PiecewisePolynomial::clamped_spline(x, y)}) {
    for (const double sigma : {0.3, 0.9}) {
      CAPTURE(sigma);
      for (const double mean : {0.0, 0.6, -2.0}) {
        CAPTURE(mean);
        CHECK(calc_mean_slope(law, sigma, mean) ==
              Approx(integrate_force(law, sigma, mean)).epsilon(1e-7).margin(1e-8));
      }
    }
  }
}

TEST_CASE("A mean slope needs some motion", "[forces]") {
  CHECK_THROWS_WITH(calc_mean_slope(PiecewisePolynomial({0.0, 1.0}), 0.0),
                    "calc_mean_slope: sigma must be > 0, got 0");
}

TEST_CASE("Lines in one line have one slope", "[forces]") {
  CHECK(dynamics::has_one_slope(PiecewisePolynomial({0.0, 3.0})));
  CHECK(dynamics::has_one_slope(
      PiecewisePolynomial::through_points(std::array{-1.0, 0.1, 0.7}, std::array{-3.0, 0.3, 2.1})));
  CHECK(!dynamics::has_one_slope(
      PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0}, std::array{-3.0, 0.0, 3.1})));
  CHECK(!dynamics::has_one_slope(PiecewisePolynomial({0.0, 3.0, 0.1})));
}
