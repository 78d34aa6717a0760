#include "dynamics/joints/relative_coordinate.h"

#include <array>
#include <cmath>

#include "tests/catch.h"

using namespace sprung;
using dynamics::MarkerState;
using dynamics::RelativeCoordinate;
using Eigen::Vector2d;
using Kind = RelativeCoordinate::Kind;

namespace {

// A marker that accelerates steadily, in general position.
struct Motion {
  Vector2d r, v, a;
  double angle, omega, alpha;

  MarkerState at(double t) const {
    MarkerState state;
    state.r = r + t * v + 0.5 * t * t * a;
    state.v = v + t * a;
    state.angle = angle + t * omega + 0.5 * t * t * alpha;
    state.omega = omega + t * alpha;
    return state;
  }
  Eigen::Vector3d acceleration() const { return {a.x(), a.y(), alpha}; }
};

const Motion kA{{0.3, -0.4}, {1.1, 0.7}, {-0.6, 2.0}, 0.8, 1.3, -0.9};
const Motion kB{{1.7, 0.9}, {-0.5, 0.4}, {1.4, -0.3}, -2.1, -0.7, 1.6};

const std::array kCoordinates{RelativeCoordinate(Kind::kX), RelativeCoordinate(Kind::kY),
                              RelativeCoordinate(Kind::kAngle), RelativeCoordinate(Kind::kAlong, {2.0, -1.0}),
                              RelativeCoordinate(Kind::kDistance)};

}  // namespace

TEST_CASE("A relative coordinate's gradient and drift are the derivatives of its value along any motion",
          "[joints]") {
  constexpr double h = 1e-3;  // s; differences of fourth order: errors of about 1e-12 and 1e-10
  for (const RelativeCoordinate& coordinate : kCoordinates) {
    CAPTURE(static_cast<int>(coordinate.kind()));
    const auto value = [&](double t) { return coordinate.value(kA.at(t), kB.at(t)); };
    const MarkerState a = kA.at(0.0), b = kB.at(0.0);
    const double rate = (8.0 * (value(h) - value(-h)) - (value(2 * h) - value(-2 * h))) / (12.0 * h);
    CHECK(coordinate.rate(a, b) == Approx(rate).epsilon(1e-9));

    const double second =
        (16.0 * (value(h) + value(-h)) - (value(2 * h) + value(-2 * h)) - 30.0 * value(0.0)) / (12.0 * h * h);
    const RelativeCoordinate::Gradient G = coordinate.gradient(a, b);
    const double from_accelerations = G.a.dot(kA.acceleration()) + G.b.dot(kB.acceleration());
    CHECK(from_accelerations + coordinate.drift(a, b) == Approx(second).epsilon(1e-7));
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
