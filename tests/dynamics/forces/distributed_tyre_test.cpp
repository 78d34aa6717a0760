#include "dynamics/forces/distributed_tyre.h"

#include <array>
#include <cmath>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/forces/wheel_overlap.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::DistributedTyre;
using dynamics::Instant;
using dynamics::MarkerState;
using dynamics::PiecewisePolynomial;
using dynamics::Power;
using dynamics::Wrench;
using Eigen::Vector2d;

namespace {

constexpr double kRadius = 0.6, kDamping = 4000.0;
const PiecewisePolynomial kSpring({0.0, 1.0e5, 5.0e7});

DistributedTyre make_tyre(const dynamics::Road& road, double direction = 1.0) {
  return DistributedTyre(
      "tyre", {.marker = 0, .radius = kRadius, .multiplicity = 2.0, .spring = kSpring, .damping = kDamping},
      {&road, direction, 0.0});
}

// One marker in uniform motion.
struct Wheel {
  std::array<MarkerState, 1> markers;
  Wheel(const Vector2d& r, const Vector2d& v) {
    markers[0].r = r;
    markers[0].v = v;
  }
  Instant instant() const { return {0.0, markers}; }
};

struct Acting {
  Vector2d force;
  Power power;
  std::array<int, 2> branches{};
};

Acting act(const dynamics::ForceElement& tyre, const Wheel& wheel) {
  Acting acting;
  tyre.choose_branches(wheel.instant(), acting.branches);
  std::array<Wrench, 1> wrenches;
  acting.power = tyre.add_wrenches(wheel.instant(), acting.branches, wrenches);
  acting.force = wrenches[0].force;
  return acting;
}

}  // namespace

TEST_CASE("On level ground distributed and point contact give the same forces", "[forces]") {
  const dynamics::FlatRoad road;
  const DistributedTyre distributed = make_tyre(road);
  const dynamics::PointContactTyre point(
      "tyre", {.marker = 0, .radius = kRadius, .multiplicity = 2.0, .spring = kSpring, .damping = kDamping},
      {&road, 1.0, 0.0});
  for (const double penetration : {-0.1, 0.001, 0.025, 0.15}) {
    for (const double sinking : {-0.4, 0.0, 1.3}) {
      CAPTURE(penetration, sinking);
      const Wheel wheel({2.3, kRadius - penetration}, {7.0, -sinking});
      const Acting found = act(distributed, wheel), expected = act(point, wheel);
      CHECK(found.force.y() == Approx(expected.force.y()).epsilon(1e-9));
      CHECK(found.force.x() == 0.0);
      CHECK(found.branches[0] == expected.branches[0]);
      CHECK(found.power.dissipated == Approx(expected.power.dissipated).epsilon(1e-9));
    }
  }
}

TEST_CASE("Over an obstacle the tyre loses energy only by its damper", "[forces]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = 5.0, .length = 0.4, .height = 0.1});
  constexpr double h = 1e-6;  // s
  for (const double direction : {1.0, -1.0}) {
    const DistributedTyre tyre = make_tyre(road, direction);
    for (const double s : {4.75, 5.02, 5.2, 5.55}) {
      CAPTURE(direction, s);
      const Vector2d r(direction * s, 0.56), v(direction * 3.0, -0.7);
      const Acting acting = act(tyre, Wheel(r, v));
      REQUIRE(acting.branches[0] == 1);
      const auto stored = [&](double t) {
        return tyre.calc_stored_energy(Wheel(r + t * v, v).instant(), acting.branches);
      };
      const double stored_rate = (stored(h) - stored(-h)) / (2.0 * h);
      CHECK(acting.power.input == 0.0);
      CHECK(acting.power.dissipated >= 0.0);
      CHECK(stored_rate + acting.power.dissipated == Approx(-acting.force.dot(v)).epsilon(1e-6));
    }
  }
}

TEST_CASE("An edge ahead pushes the wheel back, and lifts it less than with point contact", "[forces]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kRamp, .start = 5.2, .length = 1e-6, .height = 0.05});
  const DistributedTyre tyre = make_tyre(road);
  const double y = kRadius - 0.03;
  const Acting acting = act(tyre, Wheel({5.0, y}, {0.0, 0.0}));
  // At rest, pressure p = spring(δ)/level width acts over the width upwards and over the step's face
  // backwards.
  const dynamics::WheelOverlap overlap = dynamics::calc_wheel_overlap(road, 5.0, y, kRadius, 480);
  const double penetration = dynamics::find_level_penetration(kRadius, overlap.area);
  const double pressure =
      kSpring.value(penetration) / (2.0 * std::sqrt(penetration * (2.0 * kRadius - penetration)));
  CHECK(penetration > 0.03);
  CHECK(acting.force.y() == Approx(2.0 * pressure * overlap.width).epsilon(1e-6));
  const double bottom = y - std::sqrt(kRadius * kRadius - 0.2 * 0.2);  // of the circle at the edge
  CHECK(acting.force.x() == Approx(-2.0 * pressure * (0.05 - bottom)).epsilon(1e-6));
}

TEST_CASE("The integrator stops where the wheel's front edge reaches the next segment", "[forces]") {
  const dynamics::BumpRoad road(
      {.shape = dynamics::BumpShape::kHalfSine, .start = 5.0, .length = 0.4, .height = 0.1});
  const DistributedTyre tyre = make_tyre(road);
  const Wheel wheel({4.3, 0.58}, {3.0, 0.0});
  const Acting acting = act(tyre, wheel);
  CHECK(acting.branches[1] == 0);
  std::array<double, 4> switches{};
  tyre.calc_switches(wheel.instant(), acting.branches, switches);
  CHECK(switches[3] == Approx(5.0 - (4.3 + kRadius)));
  CHECK(tyre.calc_longest_step(Wheel({5.1, 0.58}, {3.0, 0.0}).instant()) == Approx(0.125 * 0.4 / 3.0));
}

TEST_CASE("A distributed tyre that is to pull is refused", "[forces]") {
  const dynamics::FlatRoad road;
  CHECK_THROWS_WITH(
      DistributedTyre("tyre", {.radius = kRadius, .spring = kSpring, .one_sided = false}, {&road, 1.0, 0.0}),
      Contains("one_sided"));
}
