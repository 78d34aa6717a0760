#include "dynamics/forces/spring_damper.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::PiecewisePolynomial;
using dynamics::SpringDamper;
using dynamics::Wrench;
using Eigen::Vector2d;

namespace {

// Relative rounding of the differences that the energy books are checked with: 1e-16 of the stored energy
// over a step of 2e-5 s, against powers of some 1e-3 of it per second or more.
constexpr double kDifferences = 1e-7;

// One axle's suspension of the truck: two springs, two dampers.
SpringDamper make_suspension() {
  PiecewisePolynomial spring(std::vector<double>{0.0, 4.67e5, 1.49e6 / 2.0});
  spring.continue_straight(0.15, 6.91e6, false);
  return SpringDamper("suspension", {.marker_a = 0,
                                     .marker_b = 1,
                                     .free_length = 0.458,
                                     .multiplicity = 2.0,
                                     .spring = spring,
                                     .damper = PiecewisePolynomial::through_points(
                                         std::array{-1.0, 0.0, 1.0}, std::array{-17575.0, 0.0, 5480.0})});
}

// Both points moving, the line between them at an angle; length and its rate as given.
test::MarkerPair place(double length, double rate, double angle) {
  const Vector2d direction(std::cos(angle), std::sin(angle)), across(-direction.y(), direction.x());
  test::MarkerPair pair;
  pair.markers[0].r = {3.0, -2.0};
  pair.markers[0].v = {0.7, 1.9};
  pair.markers[1].r = pair.markers[0].r + length * direction;
  pair.markers[1].v = pair.markers[0].v + rate * direction + 2.3 * across;
  return pair;
}

std::vector<int> choose(const SpringDamper& element, const test::MarkerPair& pair) {
  std::vector<int> branches(2, 0);
  element.choose_branches(pair.instant(), branches);
  return branches;
}

}  // namespace

TEST_CASE("A spring-damper pushes its points apart along their line, by the vehicle's law", "[forces]") {
  const SpringDamper suspension = make_suspension();
  struct Point {
    double deflection, rate, force;  // of one spring, by hand from the law in the vehicle's data
  };
  const double at_stop = 4.67e5 * 0.15 + 1.49e6 * 0.0225 / 2.0;
  for (const Point& point : {Point{0.058, 0.4, 4.67e5 * 0.058 + 7.45e5 * 0.058 * 0.058 + 5480.0 * 0.4},
                             Point{0.058, -0.4, 4.67e5 * 0.058 + 7.45e5 * 0.058 * 0.058 - 17575.0 * 0.4},
                             Point{0.17, 1.0, at_stop + 6.91e6 * 0.02 + 5480.0},
                             Point{-0.03, -0.2, -4.67e5 * 0.03 + 7.45e5 * 0.0009 - 17575.0 * 0.2}}) {
    const double angle = 2.1;
    const test::MarkerPair pair = place(0.458 - point.deflection, -point.rate, angle);
    std::vector<Wrench> wrenches(2);
    const dynamics::Power power = suspension.add_wrenches(pair.instant(), choose(suspension, pair), wrenches);
    const Vector2d expected = 2.0 * point.force * Vector2d(std::cos(angle), std::sin(angle));
    CHECK((wrenches[1].force - expected).norm() < 1e-11 * expected.norm());
    CHECK(wrenches[0].force == -wrenches[1].force);
    CHECK(wrenches[0].torque == 0.0);
    CHECK(wrenches[1].torque == 0.0);
    CHECK(power.input == 0.0);
    CHECK(power.dissipated ==
          Approx(2.0 * (point.rate > 0.0 ? 5480.0 : 17575.0) * point.rate * point.rate).epsilon(1e-11));

    std::array<double, 4> values{};
    suspension.calc_channels(pair.instant(), choose(suspension, pair), values);
    REQUIRE(suspension.channels().size() == 4);
    CHECK(values[0] == Approx(0.458 - point.deflection).epsilon(1e-13));
    CHECK(values[1] == Approx(point.deflection).epsilon(1e-12));
    CHECK(values[2] == Approx(point.rate).epsilon(1e-12));
    CHECK(values[3] == Approx(2.0 * point.force).epsilon(1e-11));
  }
}

TEST_CASE("Forces are added to what is there", "[forces]") {
  const SpringDamper suspension = make_suspension();
  const test::MarkerPair pair = place(0.4, 0.3, -0.6);
  std::vector<Wrench> once(2), on_top(2);
  on_top[0].force = {10.0, 20.0};
  suspension.add_wrenches(pair.instant(), choose(suspension, pair), once);
  suspension.add_wrenches(pair.instant(), choose(suspension, pair), on_top);
  CHECK((on_top[0].force - once[0].force - Vector2d(10.0, 20.0)).norm() < 1e-10);
}

TEST_CASE("A spring-damper's stored and dissipated energy are what its points give", "[forces]") {
  const SpringDamper suspension = make_suspension();
  test::RandomNumbers random(21);
  std::map<std::vector<int>, int> met;
  for (int i = 0; i < 200; ++i) {
    const test::MarkerPair pair =
        place(random.between(0.2, 0.6), random.size_up_to(3.0), random.between(-3.0, 3.0));
    const std::vector<int> branches = choose(suspension, pair);
    ++met[branches];
    CHECK(std::abs(test::calc_energy_leak(suspension, pair, branches)) < kDifferences);
  }
  CHECK(met.size() == 4);  // both pieces of the spring with both of the damper
}

TEST_CASE("A spring-damper's switches are where its pieces end", "[forces]") {
  const SpringDamper suspension = make_suspension();
  REQUIRE(suspension.num_switches() == 4);
  const auto switches = [&](const test::MarkerPair& pair, std::vector<int> branches) {
    std::array<double, 4> values{};
    suspension.calc_switches(pair.instant(), branches, values);
    return values;
  };
  // Well inside a piece all are positive
  for (const test::MarkerPair& pair : {place(0.4, 0.5, 1.0), place(0.28, 0.5, 1.0), place(0.4, -0.5, 1.0)}) {
    for (const double value : switches(pair, choose(suspension, pair))) CHECK(value > 0.0);
  }
  // Beyond an end the piece's switch is negative: the stop engaged, the damper turned round
  CHECK(switches(place(0.458 - 0.151, 0.5, 1.0), {0, 0})[1] < 0.0);
  CHECK(switches(place(0.458 - 0.149, 0.5, 1.0), {1, 0})[0] < 0.0);
  CHECK(switches(place(0.4, -0.5, 1.0), {0, 0})[3] < 0.0);
  CHECK(switches(place(0.4, 0.5, 1.0), {0, 1})[2] < 0.0);
}

TEST_CASE("A law of one piece has no switches", "[forces]") {
  // A damper with a kink beside a spring of one piece: the kink's switches are the first, and alone.
  const auto make = [](PiecewisePolynomial damper) {
    return SpringDamper("linear", {.marker_a = 0,
                                   .marker_b = 1,
                                   .free_length = 0.458,
                                   .spring = PiecewisePolynomial(std::vector<double>{0.0, 4e5}),
                                   .damper = std::move(damper)});
  };
  CHECK(make(PiecewisePolynomial(std::vector<double>{0.0, 5e3})).num_switches() == 0);
  const SpringDamper kinked = make(PiecewisePolynomial::from_pieces({0.0}, {{0.0, 2e4}, {0.0, 5e3}}));
  REQUIRE(kinked.num_switches() == 2);
  std::array<double, 2> values{};
  kinked.calc_switches(place(0.4, -0.5, 1.0).instant(), std::vector<int>{0, 0}, values);
  CHECK(values[0] > 0.0);
  CHECK(values[1] < 0.0);
}

TEST_CASE("Two coinciding points get no force and no NaN", "[forces]") {
  const SpringDamper suspension = make_suspension();
  const test::MarkerPair pair = place(0.0, 0.0, 1.0);
  std::vector<Wrench> wrenches(2);
  suspension.add_wrenches(pair.instant(), choose(suspension, pair), wrenches);
  CHECK(wrenches[0].force.isZero(0.0));
  CHECK(wrenches[1].force.isZero(0.0));
}
