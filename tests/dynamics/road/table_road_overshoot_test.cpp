#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "dynamics/road/table_road.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::TableRoad;

namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

struct Points {
  std::vector<double> s, height;
};

// (1 − cos)/2 waves, level at both ends like the spline: 8 of length 1 with `per_wave` points on each.
Points make_waves(int per_wave) {
  Points points;
  for (int i = 0; i <= 8 * per_wave; ++i) {
    points.s.push_back(static_cast<double>(i) / per_wave);
    points.height.push_back(0.5 - 0.5 * std::cos(kTau * points.s.back()));
  }
  return points;
}

double wave(double s) {
  return 0.5 - 0.5 * std::cos(kTau * s);
}

double slope_at(const TableRoad& road, double s) {
  return road.sample(1, s).slope;
}

}  // namespace

TEST_CASE("Between points a table road is wrong by no more than 5/384 spacing⁴ of the fourth derivative",
          "[road]") {
  for (const int per_wave : {6, 12, 24}) {
    const Points points = make_waves(per_wave);
    const TableRoad road(0.0, points.s, points.height);
    CHECK(road.num_limited() == 0);
    double error = 0.0;
    for (double s = 0.0; s <= 8.0; s += 0.0037) error = std::max(error, std::abs(road.height(s) - wave(s)));
    const double bound = 5.0 / 384.0 * std::pow(kTau / per_wave, 4) * 0.5;
    CHECK(error <= bound);
    CHECK(error >= 0.2 * bound);  // it is of fourth order, not better by accident of a wrong comparison
  }
}

TEST_CASE("A table road through a smooth road's points has no kink and no jump of curvature", "[road]") {
  const Points points = make_waves(6);
  const TableRoad road(0.0, points.s, points.height);
  constexpr double kStep = 1e-5;
  for (std::size_t i = 1; i + 1 < points.s.size(); ++i) {
    const double at = points.s[i];
    const double before = (slope_at(road, at) - slope_at(road, at - kStep)) / kStep;
    const double behind = (slope_at(road, at + kStep) - slope_at(road, at)) / kStep;
    // Curvature is up to ½(2π)² = 19.7; one-sided differences miss half a step times the third derivative,
    // 124 at most.
    CHECK(behind == Approx(before).margin(2.0 * 124.0 * kStep));
  }
}

TEST_CASE("A table road does not overshoot at a kerb, up or down", "[road]") {
  for (const double rise : {0.15, -0.15}) {
    const std::vector<double> s{0.0, 1.0, 2.0, 3.0, 3.02, 4.0, 5.0, 6.0};
    const std::vector<double> height{0.0, 0.0, 0.0, 0.0, rise, rise, rise, rise};
    const TableRoad road(0.0, s, height);
    CHECK(road.num_limited() > 0);
    double last = 0.0;
    for (double at = 0.0; at <= 6.0; at += 0.001) {
      const double now = road.height(at);
      CHECK((now - last) * rise >= -1e-16);  // never back
      CHECK(now / rise <= 1.0 + 1e-12);
      last = now;
    }
    CHECK(road.height(2.5) == 0.0);
    CHECK(road.height(4.5) == rise);
    CHECK(road.height(3.01) == Approx(0.5 * rise).epsilon(1e-12));
  }
}

TEST_CASE("Limiting a kerb leaves a smooth stretch of the same road as it was", "[road]") {
  Points points = make_waves(12);
  const TableRoad smooth(0.0, points.s, points.height);
  for (const double kerb : {0.0, 0.1, 0.1}) {
    points.s.push_back(points.s.back() + (kerb > 0.0 && points.height.back() == 0.0 ? 0.01 : 1.0));
    points.height.push_back(kerb);
  }
  const TableRoad road(0.0, points.s, points.height);
  CHECK(road.num_limited() > 0);
  for (double at = 0.0; at <= 6.0; at += 0.01)
    CHECK(road.height(at) == Approx(smooth.height(at)).margin(1e-5));
}

TEST_CASE("On a monotone stretch a table road of any heights overshoots by a hundredth at most", "[road]") {
  std::mt19937 generator(7);  // NOLINT: the same points every time
  std::uniform_real_distribution<double> height(-0.1, 0.1), step(0.01, 1.0);
  Points points{{0.0}, {0.0}};
  for (int i = 0; i < 400; ++i) {
    points.s.push_back(points.s.back() + step(generator));
    points.height.push_back(i % 7 == 3 ? points.height.back() : height(generator));
  }
  const TableRoad road(0.0, points.s, points.height);
  for (std::size_t i = 1; i + 2 < points.s.size(); ++i) {
    const double* h = &points.height[i - 1];
    if ((h[1] - h[0]) * (h[3] - h[2]) < 0.0) continue;
    const auto [low, high] = std::minmax({h[1], h[2]});
    const double margin =
        0.01 * (std::max({h[0], h[1], h[2], h[3]}) - std::min({h[0], h[1], h[2], h[3]})) + 1e-15;
    for (int k = 1; k < 40; ++k) {
      const double at = points.s[i] + k / 40.0 * (points.s[i + 1] - points.s[i]);
      CHECK(road.height(at) >= low - margin);
      CHECK(road.height(at) <= high + margin);
    }
    CHECK(road.height(points.s[i]) == Approx(points.height[i]).margin(1e-15));
  }
}
