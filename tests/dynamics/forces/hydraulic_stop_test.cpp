#include "dynamics/forces/hydraulic_stop.h"

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::HydraulicStop;
using dynamics::PiecewisePolynomial;
using dynamics::Wrench;
using Eigen::Vector2d;

namespace {

// As for the spring-damper.
constexpr double kDifferences = 1e-7;

// At a rate of −2 m/s the force is zero. The orifice closes from 1e3 to 5e3 N·s²/m² over an overlap of 0.1 m.
const HydraulicStop& stop() {
  static const HydraulicStop made("stop", {.marker_a = 0,
                                           .marker_b = 1,
                                           .contact_length = 0.3,
                                           .spring = PiecewisePolynomial({0.0, 4.0e4}),
                                           .metering = PiecewisePolynomial::through_points(
                                               std::array{0.0, 0.1, 0.2}, std::array{1.0e3, 5.0e3, 5.0e3}),
                                           .damping = 2.0e4});
  return made;
}

// Both points moving, the line between them at an angle; overlap and its rate as given.
test::MarkerPair place(double overlap, double rate, double angle) {
  const Vector2d direction(std::cos(angle), std::sin(angle)), across(-direction.y(), direction.x());
  test::MarkerPair pair;
  pair.markers[0].r = {3.0, -2.0};
  pair.markers[0].v = {0.7, 1.9};
  pair.markers[1].r = pair.markers[0].r + (0.3 - overlap) * direction;
  pair.markers[1].v = pair.markers[0].v - rate * direction + 2.3 * across;
  return pair;
}

std::vector<int> choose(const test::MarkerPair& pair) {
  std::vector<int> branches(4, 0);
  stop().choose_branches(pair.instant(), branches);
  return branches;
}

}  // namespace

TEST_CASE(
    "A hydraulic stop pushes its points apart once they are closer than its contact length, and never pulls",
    "[forces]") {
  struct Point {
    double overlap, rate, force, stored;  // by hand: δ (4e4 + 2e4 δ̇), 2e4 δ²; 5e3 or 3e3 δ̇² for δ̇ > 0
  };
  for (const Point& point :
       {Point{0.1, 0.0, 4000.0, 200.0}, Point{0.1, 1.5, 18250.0, 200.0}, Point{0.05, 1.0, 6000.0, 50.0},
        Point{0.05, -1.0, 1000.0, 50.0}, Point{0.05, -3.0, 0.0, 50.0}, Point{-0.05, 1.5, 0.0, 0.0},
        Point{-0.05, -1.5, 0.0, 0.0}}) {
    const double angle = 2.1;
    const test::MarkerPair pair = place(point.overlap, point.rate, angle);
    std::vector<Wrench> wrenches(2);
    const dynamics::Power power = stop().add_wrenches(pair.instant(), choose(pair), wrenches);
    const Vector2d expected = point.force * Vector2d(std::cos(angle), std::sin(angle));
    CHECK((wrenches[1].force - expected).norm() < 1e-9);
    CHECK(wrenches[0].force == -wrenches[1].force);
    CHECK(wrenches[0].torque == 0.0);
    CHECK(wrenches[1].torque == 0.0);
    CHECK(power.input == 0.0);
    CHECK(power.dissipated >= 0.0);
    CHECK(stop().calc_stored_energy(pair.instant(), choose(pair)) == Approx(point.stored).epsilon(1e-11));

    std::array<double, 4> values{};
    REQUIRE(stop().channels().size() == 4);
    stop().calc_channels(pair.instant(), choose(pair), values);
    CHECK(values[0] == Approx(0.3 - point.overlap).epsilon(1e-12));
    CHECK(values[1] == Approx(point.overlap).epsilon(1e-12));
    CHECK(values[2] == Approx(point.rate).margin(1e-12));
    CHECK(values[3] == Approx(point.force).margin(1e-9));
  }
}

TEST_CASE("A hydraulic stop's stored and dissipated energy are what its points give", "[forces]") {
  test::RandomNumbers random(33);
  std::map<std::vector<int>, int> met;
  for (int i = 0; i < 200; ++i) {
    const test::MarkerPair pair =
        place(random.size_up_to(0.2), random.size_up_to(5.0), random.between(-3.0, 3.0));
    const std::vector<int> branches = choose(pair);
    ++met[branches];
    CHECK(std::abs(test::calc_energy_leak(stop(), pair, branches)) < kDifferences);
  }
  CHECK(met.size() >= 6);  // apart; pushing to and fro, without force, each at an orifice that closes or not
}

TEST_CASE("A hydraulic stop's switches are where it touches and where its force passes through zero",
          "[forces]") {
  const auto switches = [](const test::MarkerPair& pair, std::vector<int> branches) {
    std::array<double, 5> values{};
    stop().calc_switches(pair.instant(), branches, values);
    return values;
  };
  for (const test::MarkerPair& pair :
       {place(-0.1, 1.0, 1.0), place(0.09, 1.0, 1.0), place(0.09, -3.0, 1.0)}) {
    for (const double value : switches(pair, choose(pair))) CHECK(value > 0.0);
  }
  CHECK(choose(place(-0.1, 1.0, 1.0)) != choose(place(0.1, 1.0, 1.0)));
  CHECK(choose(place(0.1, -3.0, 1.0)) != choose(place(0.1, 1.0, 1.0)));
  // Beyond an end the branch's switch is negative
  CHECK(switches(place(0.01, 1.0, 1.0), choose(place(-0.1, 1.0, 1.0)))[0] < 0.0);
  CHECK(switches(place(-0.01, -1.0, 1.0), choose(place(0.1, -1.0, 1.0)))[0] < 0.0);
  CHECK(switches(place(0.09, -2.1, 1.0), choose(place(0.09, -1.0, 1.0)))[1] < 0.0);
  CHECK(switches(place(0.09, -1.9, 1.0), choose(place(0.09, -3.0, 1.0)))[1] < 0.0);
  CHECK(switches(place(0.09, 0.1, 1.0), choose(place(0.09, -0.1, 1.0)))[2] < 0.0);
  CHECK(switches(place(0.11, 0.1, 1.0), choose(place(0.09, 0.1, 1.0)))[4] < 0.0);
}
