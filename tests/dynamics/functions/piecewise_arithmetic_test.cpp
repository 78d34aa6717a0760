#include "dynamics/functions/piecewise_arithmetic.h"

#include <array>
#include <cmath>
#include <vector>

#include "tests/catch.h"

using namespace sprung;
using dynamics::PiecewisePolynomial;

namespace {

constexpr std::array kX{-1.3, 0.2, 0.9, 2.1}, kY{0.4, -1.0, 2.5, 0.3};
constexpr std::array kU{-0.6, 0.9, 1.4}, kV{2.0, -0.7, 1.1};
constexpr std::array kPlaces{-4.0, -1.3, -1.0, -0.6, 0.1, 0.2, 0.5, 0.9, 1.2, 1.9, 2.1, 5.0};

}  // namespace

TEST_CASE("Sums and products have the sum and the product of the values everywhere", "[forces]") {
  const std::array functions{PiecewisePolynomial::through_points(kX, kY),
                             PiecewisePolynomial::clamped_spline(kU, kV),
                             PiecewisePolynomial(std::vector<double>{0.3, -1.0, 0.2})};
  for (const PiecewisePolynomial& a : functions) {
    for (const PiecewisePolynomial& b : functions) {
      const PiecewisePolynomial sum = calc_sum(a, b), product = calc_product(a, b);
      for (const double x : kPlaces) {
        CAPTURE(x);
        CHECK(sum.value(x) == Approx(a.value(x) + b.value(x)).epsilon(1e-12).margin(1e-13));
        CHECK(product.value(x) == Approx(a.value(x) * b.value(x)).epsilon(1e-12).margin(1e-13));
        CHECK(product.slope(x) ==
              Approx(a.slope(x) * b.value(x) + a.value(x) * b.slope(x)).epsilon(1e-12).margin(1e-12));
      }
    }
  }
}

TEST_CASE("Joined parts hold between their ends, the later one at an end", "[forces]") {
  const std::vector<PiecewisePolynomial> parts{PiecewisePolynomial::through_points(kX, kY),
                                               PiecewisePolynomial(std::vector<double>{1.0, 1.0}),
                                               PiecewisePolynomial::clamped_spline(kU, kV)};
  constexpr std::array kEnds{0.5, 1.0};
  const PiecewisePolynomial f = dynamics::join_parts(kEnds, parts);
  for (const double x : kPlaces) {
    CAPTURE(x);
    const PiecewisePolynomial& part = parts[x < 0.5 ? 0 : x < 1.0 ? 1 : 2];
    CHECK(f.value(x) == Approx(part.value(x)).epsilon(1e-13).margin(1e-14));
  }
  CHECK(f.value(0.5) == Approx(1.5).epsilon(1e-15));
  CHECK(f.value(std::nextafter(0.5, 0.0)) == Approx(0.5).epsilon(1e-14));  // −1 + 5 · 0.3, on the line
  // The breaks of the first line, and those of the others that lie inside: 0.9 belongs to the second part's
  // time.
  CHECK(std::vector<double>(f.breaks().begin(), f.breaks().end()) == std::vector<double>{0.2, 0.5, 1.0});
  // ∫ from 0 to 1: the lines up to 0.5 by trapezoids, then ∫ (1 + x) dx.
  const double at_zero = 0.4 - 1.4 * 1.3 / 1.5;
  const double lines = 0.5 * (at_zero - 1.0) * 0.2 + 0.5 * (-1.0 + 0.5) * 0.3;
  CHECK(f.integral(1.0) == Approx(lines + 0.5 + 0.5 * (1.0 - 0.25)).epsilon(1e-13));
}

TEST_CASE("A function that jumps between constants is not constant", "[forces]") {
  const PiecewisePolynomial one(std::vector<double>{1.0, 0.0}), two(std::vector<double>{2.0});
  constexpr std::array kEnd{0.0};
  CHECK(one.is_constant());
  CHECK(dynamics::join_parts(kEnd, std::vector{one, one}).is_constant());
  CHECK_FALSE(dynamics::join_parts(kEnd, std::vector{one, two}).is_constant());
  CHECK_FALSE(PiecewisePolynomial(std::vector<double>{1.0, 0.1}).is_constant());
}

TEST_CASE("Parts that do not match their ends are refused", "[forces]") {
  constexpr std::array kEnd{0.0};
  CHECK_THROWS_WITH(dynamics::join_parts(kEnd, std::vector{PiecewisePolynomial()}),
                    "join_parts: needs one more part than ends, got 1 and 1");
}
