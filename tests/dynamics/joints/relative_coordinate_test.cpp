#include "dynamics/joints/relative_coordinate.h"

#include <array>
#include <cmath>

#include "tests/catch.h"
#include "tests/dynamics/marker_motion.h"

using namespace sprung;
using dynamics::MarkerState;
using dynamics::RelativeCoordinate;
using test::MarkerMotion;
using Kind = RelativeCoordinate::Kind;

namespace {

// In general position.
const MarkerMotion kA{{0.3, -0.4}, {1.1, 0.7}, {-0.6, 2.0}, 0.8, 1.3, -0.9};
const MarkerMotion kB{{1.7, 0.9}, {-0.5, 0.4}, {1.4, -0.3}, -2.1, -0.7, 1.6};

const std::array kCoordinates{RelativeCoordinate(Kind::kX), RelativeCoordinate(Kind::kY),
                              RelativeCoordinate(Kind::kAngle), RelativeCoordinate(Kind::kAlong, {2.0, -1.0}),
                              RelativeCoordinate(Kind::kDistance)};

}  // namespace

TEST_CASE("A relative coordinate's gradient and drift are the derivatives of its value along any motion",
          "[joints]") {
  for (const RelativeCoordinate& coordinate : kCoordinates) {
    CAPTURE(static_cast<int>(coordinate.kind()));
    const auto value = [&](double t) { return coordinate.value(kA.at(t), kB.at(t)); };
    const MarkerState a = kA.at(0.0), b = kB.at(0.0);
    CHECK(coordinate.rate(a, b) == Approx(test::calc_rate(value)).epsilon(1e-9));

    const RelativeCoordinate::Gradient G = coordinate.gradient(a, b);
    const double from_accelerations = G.a.dot(kA.acceleration()) + G.b.dot(kB.acceleration());
    CHECK(from_accelerations + coordinate.drift(a, b) == Approx(test::calc_second_rate(value)).epsilon(1e-7));
  }
}

TEST_CASE("The values of relative coordinates are b as seen from a", "[joints]") {
  MarkerState a, b;
  a.r = {1.0, 2.0};
  a.angle = 0.5 * 3.14159265358979323846;  // a's x axis points along the world's y
  b.r = {4.0, 6.0};
  b.angle = 7.0;  // angles count full turns
  CHECK(RelativeCoordinate(Kind::kX).value(a, b) == 3.0);
  CHECK(RelativeCoordinate(Kind::kY).value(a, b) == 4.0);
  CHECK(RelativeCoordinate(Kind::kAngle).value(a, b) == Approx(7.0 - a.angle).epsilon(1e-15));
  CHECK(RelativeCoordinate(Kind::kAlong, {5.0, 0.0}).value(a, b) == Approx(4.0).epsilon(1e-15));
  CHECK(RelativeCoordinate(Kind::kAlong, {0.0, 0.1}).value(a, b) == Approx(-3.0).epsilon(1e-15));
  CHECK(RelativeCoordinate(Kind::kDistance).value(a, b) == 5.0);
}
