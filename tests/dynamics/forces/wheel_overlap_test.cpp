#include "dynamics/forces/wheel_overlap.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "dynamics/road/table_road.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::BumpRoad;
using dynamics::BumpShape;
using dynamics::WheelOverlap;

namespace {

constexpr double kRadius = 0.6;
constexpr int kCells = 48;

WheelOverlap overlap(const dynamics::Road& road, double s, double y) {
  return dynamics::calc_wheel_overlap(road, s, y, kRadius, kCells);
}

// ∫ √(R² − ξ²) dξ from 0.
double circle_integral(double xi) {
  return 0.5 * (xi * std::sqrt(kRadius * kRadius - xi * xi) + kRadius * kRadius * std::asin(xi / kRadius));
}

}  // namespace

TEST_CASE("On level ground the overlap is a segment of the circle", "[forces]") {
  const dynamics::FlatRoad road;
  for (const double penetration : {1e-6, 0.003, 0.025, 0.2, 0.5}) {
    CAPTURE(penetration);
    const WheelOverlap found = overlap(road, 3.7, kRadius - penetration);
    const double half = std::sqrt(penetration * (2.0 * kRadius - penetration));
    // e = δ − R + √(R² − ξ²) from −half to half.
    const double area = 2.0 * (circle_integral(half) - (kRadius - penetration) * half);
    CHECK(found.area == Approx(area).epsilon(penetration > 1e-4 ? 1e-9 : 1e-5));
    const double alpha = std::acos(1.0 - penetration / kRadius);
    CHECK(found.area == Approx(kRadius * kRadius * (alpha - std::sin(alpha) * std::cos(alpha)))
                            .epsilon(penetration > 1e-4 ? 1e-9 : 1e-5));
    CHECK(found.width == Approx(2.0 * half).epsilon(1e-9));
    CHECK(found.rise == 0.0);
    CHECK(found.depth == Approx(penetration).epsilon(1e-9));
    CHECK(dynamics::find_level_penetration(kRadius, found.area) == Approx(penetration).epsilon(1e-9));
  }
  CHECK(overlap(road, 0.0, kRadius + 0.1).area == 0.0);
  CHECK(overlap(road, 0.0, kRadius + 0.1).depth == Approx(-0.1).epsilon(1e-12));
}

TEST_CASE("At a step the overlap is two pieces of segments, and the step's face holds the wheel back",
          "[forces]") {
  // A step of 0.08 m, 1e-7 m long, 0.1 m before the centre of a wheel that is pressed 0.03 m into the lower
  // road.
  const BumpRoad road({.shape = BumpShape::kRamp, .start = 5.1, .length = 1e-7, .height = 0.08});
  const double y = kRadius - 0.03;
  const WheelOverlap found = overlap(road, 5.0, y);
  const double low_end = std::sqrt(kRadius * kRadius - y * y);  // left end, on the lower road
  const double high_end = std::sqrt(kRadius * kRadius - std::pow(y - 0.08, 2));  // right end, on the upper
  const double area = circle_integral(0.1) + circle_integral(low_end) - y * (0.1 + low_end) +
                      circle_integral(high_end) - circle_integral(0.1) - (y - 0.08) * (high_end - 0.1);
  CHECK(found.area == Approx(area).epsilon(1e-6));
  CHECK(found.width == Approx(low_end + high_end).epsilon(1e-9));
  CHECK(found.rise == Approx(0.08).epsilon(1e-7));
  // Deepest just behind the edge: 0.08 − y + √(R² − 0.1²).
  CHECK(found.depth == Approx(0.08 - y + std::sqrt(kRadius * kRadius - 0.01)).epsilon(1e-6));
}

TEST_CASE("Width and rise are the derivatives of the area, over bumps, edges and holes", "[forces]") {
  const std::vector<double> s{0.0, 0.3, 0.5, 0.9, 1.2, 1.3}, h{0.0, 0.05, -0.06, 0.08, 0.02, 0.0};
  const dynamics::TableRoad table(4.5, s, h);
  const BumpRoad sine({.shape = BumpShape::kHalfSine, .start = 5.0, .length = 0.4, .height = 0.2});
  const BumpRoad hole({.shape = BumpShape::kTriangle, .start = 4.9, .length = 0.3, .height = -0.2});
  constexpr double step = 1e-5;
  for (const dynamics::Road* road : std::vector<const dynamics::Road*>{&table, &sine, &hole}) {
    for (const double at : {4.63, 4.87, 5.05, 5.21, 5.52}) {
      for (const double y : {0.47, 0.57}) {
        CAPTURE(road, at, y);
        const WheelOverlap found = overlap(*road, at, y);
        REQUIRE(found.area > 0.0);
        const double by_y =
            (overlap(*road, at, y + step).area - overlap(*road, at, y - step).area) / (2.0 * step);
        const double by_s =
            (overlap(*road, at + step, y).area - overlap(*road, at - step, y).area) / (2.0 * step);
        CHECK(found.width == Approx(-by_y).epsilon(1e-6));
        CHECK(found.rise == Approx(by_s).margin(1e-6));
      }
    }
  }
}

TEST_CASE("The slope of the depth is its derivative, on corners of the road, too", "[forces]") {
  const BumpRoad ramp({.shape = BumpShape::kRamp, .start = 5.0, .length = 0.02, .height = -0.1});
  const BumpRoad triangle({.shape = BumpShape::kTriangle, .start = 5.0, .length = 0.3, .height = 0.1});
  const BumpRoad bump({.shape = BumpShape::kHalfSine, .start = 5.0, .length = 0.8, .height = 0.1});
  constexpr double kShift = 1e-5;
  for (const dynamics::Road* road : {&ramp, &triangle, &bump}) {
    for (const double s : {4.83, 5.03, 5.139, 5.35}) {
      CAPTURE(s);
      for (const double y : {kRadius + 0.05, kRadius + 1e-6, kRadius - 0.02}) {
        const double slope =
            (overlap(*road, s + kShift, y).depth - overlap(*road, s - kShift, y).depth) / (2.0 * kShift);
        CHECK(overlap(*road, s, y).depth_slope == Approx(slope).margin(1e-6));
      }
    }
  }
}

TEST_CASE("The integral of a road is that of its height", "[road]") {
  const std::vector<double> s{0.0, 0.3, 0.5, 0.9, 1.2, 1.3}, h{0.0, 0.05, -0.06, 0.08, 0.02, 0.04};
  const dynamics::TableRoad table(4.5, s, h);
  constexpr double step = 1e-4;
  const auto check = [&](const dynamics::Road& road, double at) {
    const int k = road.find_segment(at, true);
    const double rate = (8.0 * (road.integral(k, at + step) - road.integral(k, at - step)) -
                         (road.integral(k, at + 2 * step) - road.integral(k, at - 2 * step))) /
                        (12.0 * step);
    CAPTURE(at, k);
    CHECK(rate == Approx(road.sample(k, at).height).margin(1e-11));
  };
  for (const double at : {4.0, 4.6, 4.91, 5.1, 5.33, 5.75, 6.2}) {
    check(table, at);
    for (int shape = 0; shape < 4; ++shape) {
      check(BumpRoad({.shape = static_cast<BumpShape>(shape), .start = 4.7, .length = 0.8, .height = 0.15}),
            at);
    }
  }
}

TEST_CASE("A narrow obstacle between samples and a hole under the wheel are seen whole", "[forces]") {
  // Against a plain sum over two million strips.
  const BumpRoad edge({.shape = BumpShape::kTriangle, .start = 4.99, .length = 0.013, .height = 0.05});
  const BumpRoad hole({.shape = BumpShape::kHalfSine, .start = 4.95, .length = 0.2, .height = -0.1});
  for (const dynamics::Road* road : std::vector<const dynamics::Road*>{&edge, &hole}) {
    for (const double y : {0.58, 0.61}) {
      double area = 0.0, width = 0.0;
      constexpr int kStrips = 2000000;
      for (int i = 0; i < kStrips; ++i) {
        const double xi = kRadius * ((2.0 * i + 1.0) / kStrips - 1.0);
        const double e = road->height(5.0 + xi) - y + std::sqrt(kRadius * kRadius - xi * xi);
        if (e <= 0.0) continue;
        area += e * 2.0 * kRadius / kStrips;
        width += 2.0 * kRadius / kStrips;
      }
      CAPTURE(road, y);
      CHECK(overlap(*road, 5.0, y).area == Approx(area).epsilon(1e-5).margin(1e-12));
      CHECK(overlap(*road, 5.0, y).width == Approx(width).margin(3e-6));
    }
  }
}
