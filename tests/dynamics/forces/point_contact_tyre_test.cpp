#include "dynamics/forces/point_contact_tyre.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::BumpRoad;
using dynamics::BumpShape;
using dynamics::PiecewisePolynomial;
using dynamics::PlacedRoad;
using dynamics::PointContactTyre;
using dynamics::Wrench;

namespace {

// Relative rounding of the differences that the energy books are checked with: 1e-16 of the stored energy
// over a step of 2e-5 s, against powers of some 1e-3 of it per second or more.
constexpr double kDifferences = 1e-7;

constexpr int kInAir = 0, kPressed = 1, kTouching = 2;

const dynamics::FlatRoad flat;
const BumpRoad bump({.shape = BumpShape::kHalfSine, .start = 1.0, .length = 0.4, .height = 0.2});

// One axle's tyres of the truck, on marker 1.
PointContactTyre make_tyre(const PlacedRoad& road, bool one_sided = true) {
  // A law that pulls where there is no contact, for tyres that are not one-sided
  const PiecewisePolynomial spring(one_sided ? std::vector<double>{0.0, 0.0, 5.649e7}
                                             : std::vector<double>{0.0, 2.0e6, 0.0, 3.0e7});
  return PointContactTyre("tyre",
                          {.marker = 1,
                           .radius = 0.6,
                           .multiplicity = 2.0,
                           .spring = spring,
                           .damping = 4625.0,
                           .one_sided = one_sided},
                          road);
}

test::MarkerPair place(double x, double y, double vx, double vy) {
  test::MarkerPair pair;
  pair.markers[1].r = {x, y};
  pair.markers[1].v = {vx, vy};
  return pair;
}

std::vector<int> choose(const PointContactTyre& tyre, const test::MarkerPair& pair,
                        int contact_before = kInAir) {
  std::vector<int> branches{contact_before, 0};
  tyre.choose_branches(pair.instant(), branches);
  return branches;
}

double force(const PointContactTyre& tyre, const test::MarkerPair& pair) {
  std::vector<Wrench> wrenches(2);
  tyre.add_wrenches(pair.instant(), choose(tyre, pair), wrenches);
  CHECK(wrenches[1].force.x() == 0.0);
  CHECK(wrenches[1].torque == 0.0);
  CHECK(wrenches[0].force.isZero(0.0));
  return wrenches[1].force.y();
}

}  // namespace

TEST_CASE("The tyre's force on flat ground, by the vehicle's law", "[forces]") {
  const PointContactTyre tyre = make_tyre({&flat, -1.0, 0.0});
  // Two tyres, F = 5.649e7 δ² + 4625 δ̇ each
  CHECK(force(tyre, place(2.0, 0.575, -3.0, 0.0)) == Approx(2.0 * 5.649e7 * 0.025 * 0.025).epsilon(1e-12));
  CHECK(force(tyre, place(2.0, 0.58, -3.0, -0.5)) ==
        Approx(2.0 * (5.649e7 * 0.02 * 0.02 + 4625.0 * 0.5)).epsilon(1e-12));
  CHECK(force(tyre, place(2.0, 0.58, -3.0, 0.5)) ==
        Approx(2.0 * (5.649e7 * 0.02 * 0.02 - 4625.0 * 0.5)).epsilon(1e-12));
  SECTION("in the air there is none, however fast the wheel comes down") {
    CHECK(force(tyre, place(2.0, 0.601, -3.0, -5.0)) == 0.0);
    CHECK(choose(tyre, place(2.0, 0.601, -3.0, -5.0))[0] == kInAir);
  }
  SECTION("a wheel that leaves faster than the spring pushes is not pulled back") {
    const test::MarkerPair leaving = place(2.0, 0.599, -3.0, 2.0);
    CHECK(5.649e7 * 1e-6 - 4625.0 * 2.0 < 0.0);
    CHECK(force(tyre, leaving) == 0.0);
    CHECK(choose(tyre, leaving)[0] == kTouching);
  }
}

TEST_CASE("A tyre that is not one-sided pulls", "[forces]") {
  const PointContactTyre tyre = make_tyre({&flat, 1.0, 0.0}, false);
  CHECK(force(tyre, place(2.0, 0.62, 3.0, 0.1)) ==
        Approx(2.0 * (2.0e6 * -0.02 + 3.0e7 * -8e-6 - 4625.0 * 0.1)).epsilon(1e-12));
  CHECK(choose(tyre, place(2.0, 0.8, 3.0, 5.0))[0] == kPressed);
}

TEST_CASE("On a slope the road's rise under the moving wheel counts, in either direction of travel",
          "[forces]") {
  for (const double direction : {1.0, -1.0}) {
    // s = direction · x − origin: at s = 1.1 m the half-sine's height and slope
    const PlacedRoad road{&bump, direction, 5.0};
    const PointContactTyre tyre = make_tyre(road);
    const double height = 0.2 * std::sin(std::numbers::pi * 0.25),
                 slope = 0.2 * std::numbers::pi / 0.4 * std::cos(std::numbers::pi * 0.25);
    const double speed = 3.0, vy = 0.4;
    const test::MarkerPair pair = place(direction * (5.0 + 1.1), 0.6 + height - 0.02, direction * speed, vy);
    CHECK(force(tyre, pair) == Approx(2.0 * (5.649e7 * 4e-4 + 4625.0 * (slope * speed - vy))).epsilon(1e-10));
    std::array<double, 5> values{};
    REQUIRE(tyre.channels().size() == 5);
    tyre.calc_channels(pair.instant(), choose(tyre, pair), values);
    CHECK(values[1] == Approx(0.02).epsilon(1e-12));
    CHECK(values[2] == Approx(slope * speed - vy).epsilon(1e-12));
    CHECK(values[3] == 1.0);
    CHECK(values[4] == Approx(height).epsilon(1e-12));
  }
}

TEST_CASE("The tyre's energy book: stored, dissipated and put in by the road are what the wheel gets",
          "[forces]") {
  test::RandomNumbers random(31);
  for (const bool one_sided : {true, false}) {
    std::map<int, int> met;
    for (const double direction : {1.0, -1.0}) {
      const PointContactTyre tyre = make_tyre({&bump, direction, 2.0}, one_sided);
      for (int i = 0; i < 300; ++i) {
        const double s = random.between(0.9, 1.5);
        const double y = 0.6 + bump.height(s) - random.between(-0.01, 0.03);
        const test::MarkerPair pair =
            place(direction * (2.0 + s), y, direction * random.size_up_to(3.0), random.size_up_to(3.0));
        if (std::abs(s - 1.0) < 1e-3 || std::abs(s - 1.4) < 1e-3) continue;  // a kink within the difference
        const std::vector<int> branches = choose(tyre, pair);
        ++met[branches[0]];
        CHECK(std::abs(test::calc_energy_leak(tyre, pair, branches)) < kDifferences);
      }
    }
    CHECK(met.size() == (one_sided ? 3 : 1));
    for (const auto& [contact, count] : met) CHECK(count > 20);
  }
}

TEST_CASE("A clipped tyre loses what its spring gives back, and dissipates nothing else", "[forces]") {
  const PointContactTyre tyre = make_tyre({&flat, 1.0, 0.0});
  const test::MarkerPair leaving = place(2.0, 0.599, 3.0, 2.0);
  std::vector<Wrench> wrenches(2);
  const dynamics::Power power = tyre.add_wrenches(leaving.instant(), choose(tyre, leaving), wrenches);
  CHECK(power.dissipated == Approx(2.0 * (5.649e7 * 1e-6) * 2.0).epsilon(1e-9));
  CHECK(power.input == 0.0);
}

TEST_CASE("The tyre's switches: contact, sign of the force, ends of the road's segment", "[forces]") {
  const PointContactTyre tyre = make_tyre({&bump, 1.0, 0.0});
  REQUIRE(tyre.num_switches() == 4);
  const auto switches = [&](const test::MarkerPair& pair, std::vector<int> branches) {
    std::array<double, 4> values{};
    tyre.calc_switches(pair.instant(), branches, values);
    return values;
  };
  // In the air above flat ground: penetration is minus the gap
  CHECK(switches(place(0.2, 0.63, 3.0, 0.0), {kInAir, 0})[0] == Approx(0.03).epsilon(1e-12));
  CHECK(switches(place(0.2, 0.59, 3.0, 0.0), {kPressed, 0})[0] == Approx(0.01).epsilon(1e-12));
  // Force of one tyre changes sign at a rate of −5.649e7 δ²/4625
  const double rate = 5.649e7 * 1e-4 / 4625.0;
  CHECK(switches(place(0.2, 0.59, 3.0, rate - 0.01), {kPressed, 0})[1] > 0.0);
  CHECK(switches(place(0.2, 0.59, 3.0, rate + 0.01), {kPressed, 0})[1] < 0.0);
  CHECK(switches(place(0.2, 0.59, 3.0, rate + 0.01), {kTouching, 0})[1] > 0.0);
  CHECK(switches(place(0.2, 0.59, 3.0, rate - 0.01), {kTouching, 0})[1] < 0.0);
  // Segments: the bump is from 1.0 to 1.4
  CHECK(switches(place(0.9, 0.59, 3.0, 0.0), {kPressed, 0})[3] == Approx(0.1).epsilon(1e-12));
  CHECK(switches(place(1.1, 0.59, 3.0, 0.0), {kPressed, 1})[2] == Approx(0.1).epsilon(1e-12));
  CHECK(switches(place(1.1, 0.59, 3.0, 0.0), {kPressed, 1})[3] == Approx(0.3).epsilon(1e-12));
  CHECK(switches(place(1.5, 0.59, 3.0, 0.0), {kPressed, 2})[2] == Approx(0.1).epsilon(1e-12));
}

TEST_CASE("Where a segment ends, the tyre takes the one it rolls into", "[forces]") {
  const PointContactTyre tyre = make_tyre({&bump, 1.0, 0.0});
  CHECK(choose(tyre, place(1.0, 0.59, 3.0, 0.0))[1] == 1);
  CHECK(choose(tyre, place(1.0, 0.59, -3.0, 0.0))[1] == 0);
  CHECK(choose(tyre, place(1.4, 0.59, 3.0, 0.0))[1] == 2);
  CHECK(choose(tyre, place(1.4, 0.59, -3.0, 0.0))[1] == 1);
}

TEST_CASE("Where penetration is zero, the tyre takes the contact it moves into", "[forces]") {
  const PointContactTyre tyre = make_tyre({&flat, 1.0, 0.0});
  CHECK(choose(tyre, place(0.0, 0.6, 3.0, -1.0))[0] == kPressed);
  CHECK(choose(tyre, place(0.0, 0.6, 3.0, 1.0), kPressed)[0] == kInAir);
}

TEST_CASE("The tyre reports an event when it leaves or touches the ground, and only then", "[forces]") {
  const PointContactTyre tyre = make_tyre({&bump, 1.0, 0.0});
  const auto change = [&](std::array<int, 2> before, std::array<int, 2> after) {
    return tyre.describe_change(before, after);
  };
  CHECK(change({kInAir, 0}, {kPressed, 0}) == "touches the ground");
  CHECK(change({kTouching, 0}, {kInAir, 0}) == "leaves the ground");
  CHECK(change({kPressed, 0}, {kInAir, 0}) == "leaves the ground");
  CHECK(change({kPressed, 0}, {kTouching, 0}).empty());
  CHECK(change({kPressed, 0}, {kPressed, 1}).empty());
}

TEST_CASE("A tyre asks for steps no longer than the road's detail", "[forces]") {
  const PointContactTyre on_bump = make_tyre({&bump, 1.0, 0.0});
  CHECK(on_bump.calc_longest_step(place(1.2, 0.6, -3.0, 0.0).instant()) ==
        Approx(bump.resolution(1, 1.2) / 3.0).epsilon(1e-12));
  CHECK(on_bump.calc_longest_step(place(0.2, 0.6, 3.0, 0.0).instant()) ==
        std::numeric_limits<double>::infinity());
  CHECK(on_bump.calc_longest_step(place(1.2, 0.6, 0.0, 0.0).instant()) ==
        std::numeric_limits<double>::infinity());
  const PointContactTyre on_flat = make_tyre({&flat, 1.0, 0.0});
  CHECK(on_flat.calc_longest_step(place(0.2, 0.6, 3.0, 0.0).instant()) ==
        std::numeric_limits<double>::infinity());
}
