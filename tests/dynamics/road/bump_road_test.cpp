#include "dynamics/road/bump_road.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/road/flat_road.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::BumpRoad;
using dynamics::BumpShape;

namespace {

constexpr std::array kShapes{BumpShape::kHalfSine, BumpShape::kHaversine, BumpShape::kTriangle,
                             BumpShape::kRamp};

BumpRoad make_bump(BumpShape shape, double height = 0.2) {
  return BumpRoad({.shape = shape, .start = 1.5, .length = 0.8, .height = height});
}

}  // namespace

TEST_CASE("Heights of the bump shapes at quarter, middle and three quarters", "[road]") {
  struct Heights {
    BumpShape shape;
    double quarter, middle, three_quarters, behind;
  };
  for (const Heights& expected :
       {Heights{BumpShape::kHalfSine, 0.2 * std::sqrt(0.5), 0.2, 0.2 * std::sqrt(0.5), 0.0},
        Heights{BumpShape::kHaversine, 0.1, 0.2, 0.1, 0.0}, Heights{BumpShape::kTriangle, 0.1, 0.2, 0.1, 0.0},
        Heights{BumpShape::kRamp, 0.05, 0.1, 0.15, 0.2}}) {
    const BumpRoad road = make_bump(expected.shape);
    CHECK(road.height(1.0) == 0.0);
    CHECK(road.height(-100.0) == 0.0);
    CHECK(road.height(1.5) == Approx(0.0).margin(1e-15));
    CHECK(road.height(1.7) == Approx(expected.quarter).epsilon(1e-13));
    CHECK(road.height(1.9) == Approx(expected.middle).epsilon(1e-13));
    CHECK(road.height(2.1) == Approx(expected.three_quarters).epsilon(1e-13));
    CHECK(road.height(2.3) == expected.behind);
    CHECK(road.height(100.0) == expected.behind);
  }
}

TEST_CASE("A bump of negative height is a hole", "[road]") {
  for (const BumpShape shape : kShapes) {
    for (const double s : {1.6, 1.9, 2.2, 3.0}) {
      CHECK(make_bump(shape, -0.2).height(s) == -make_bump(shape, 0.2).height(s));
    }
  }
}

TEST_CASE("The slope is the derivative of the height in every segment, also beyond its ends", "[road]") {
  constexpr double kStep = 1e-6;
  for (const BumpShape shape : kShapes) {
    const BumpRoad road = make_bump(shape);
    for (int segment = 0; segment < road.num_segments(); ++segment) {
      for (const double s : {1.3, 1.5, 1.63, 1.9, 2.17, 2.3, 2.5}) {
        const double difference =
            (road.sample(segment, s + kStep).height - road.sample(segment, s - kStep).height) / (2.0 * kStep);
        CHECK(road.sample(segment, s).slope == Approx(difference).margin(1e-9));
      }
    }
  }
}

TEST_CASE("The height is continuous where segments meet; only the haversine has no kink", "[road]") {
  for (const BumpShape shape : kShapes) {
    const BumpRoad road = make_bump(shape);
    double largest_kink = 0.0;
    for (int k = 0; k + 1 < road.num_segments(); ++k) {
      const double end = road.segment_end(k);
      const dynamics::RoadSample before = road.sample(k, end), after = road.sample(k + 1, end);
      CHECK(before.height == Approx(after.height).margin(1e-15));
      largest_kink = std::max(largest_kink, std::abs(after.slope - before.slope));
    }
    if (shape == BumpShape::kHaversine)
      CHECK(largest_kink < 1e-14);
    else
      CHECK(largest_kink > 0.2);
  }
}

TEST_CASE("At the end of a segment the direction of rolling decides", "[road]") {
  for (const BumpShape shape : kShapes) {
    const BumpRoad road = make_bump(shape);
    CHECK(road.num_segments() == (shape == BumpShape::kTriangle ? 4 : 3));
    CHECK(road.segment_end(0) == 1.5);
    CHECK(road.segment_end(road.num_segments() - 2) == 2.3);
    CHECK(road.find_segment(0.0, true) == 0);
    CHECK(road.find_segment(50.0, true) == road.num_segments() - 1);
    for (int k = 0; k + 1 < road.num_segments(); ++k) {
      const double end = road.segment_end(k);
      CHECK(road.find_segment(end, true) == k + 1);
      CHECK(road.find_segment(end, false) == k);
      CHECK(road.find_segment(std::nextafter(end, 0.0), true) == k);
      CHECK(road.find_segment(std::nextafter(end, 9.0), false) == k + 1);
    }
  }
  CHECK(make_bump(BumpShape::kTriangle).segment_end(1) == Approx(1.9).epsilon(1e-15));
}

TEST_CASE("A bump holds detail on its length only", "[road]") {
  const BumpRoad road = make_bump(BumpShape::kHalfSine);
  CHECK(road.resolution(0, 1.0) == std::numeric_limits<double>::infinity());
  CHECK(road.resolution(2, 3.0) == std::numeric_limits<double>::infinity());
  CHECK(road.resolution(1, 1.9) > 0.0);
  CHECK(road.resolution(1, 1.9) < 0.8 / 4.0);  // several steps on the bump
}

TEST_CASE("A bump without length is refused", "[road]") {
  for (const double length : {0.0, -0.4, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_THROWS_AS(BumpRoad({.shape = BumpShape::kRamp, .start = 0.0, .length = length, .height = 0.1}),
                    std::invalid_argument);
    CHECK_THROWS_WITH(BumpRoad({.shape = BumpShape::kRamp, .start = 0.0, .length = length, .height = 0.1}),
                      Contains("length must be > 0 m"));
  }
}

TEST_CASE("The words for the shapes are in the order of the shapes", "[road]") {
  CHECK(dynamics::bump_shape_names() ==
        std::vector<std::string>{"half-sine", "haversine", "triangle", "ramp"});
}

TEST_CASE("A flat road is flat", "[road]") {
  const dynamics::FlatRoad road;
  CHECK(road.num_segments() == 1);
  CHECK(road.find_segment(17.0, false) == 0);
  CHECK(road.height(-3.0) == 0.0);
  CHECK(road.sample(0, 4.0).slope == 0.0);
}

TEST_CASE("A road lies along the heading from where it is placed", "[road]") {
  const BumpRoad bump = make_bump(BumpShape::kRamp);
  const dynamics::PlacedRoad forward{&bump, 1.0, 10.0}, backward{&bump, -1.0, -4.0};
  CHECK(forward.distance(12.5) == 2.5);
  CHECK(backward.distance(1.0) == 3.0);  // towards −x from x = 4
}
