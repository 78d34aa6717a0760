#include "dynamics/forces/bushing.h"

#include <array>
#include <cmath>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::Bushing;
using dynamics::PiecewisePolynomial;
using dynamics::Wrench;
using Eigen::Vector2d;

namespace {

// As for the spring-damper.
constexpr double kDifferences = 1e-7;

const Bushing& bushing() {
  static const Bushing made(
      "mount",
      {.marker_a = 0,
       .marker_b = 1,
       .angle = 0.4,
       .free_position = {0.02, -0.03},
       .free_angle = 0.1,
       .multiplicity = 2.0,
       .directions = {
           {{PiecewisePolynomial({3.0, 500.0, 70.0}), PiecewisePolynomial({0.0, 8.0})},
            {PiecewisePolynomial::through_points(std::array{-0.1, 0.0, 0.1}, std::array{-40.0, 0.0, 90.0}),
             PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0}, std::array{-3.0, 0.0, 7.0})},
            {PiecewisePolynomial({0.0, 20.0}), PiecewisePolynomial({0.0, 0.5})}}}});
  return made;
}

std::vector<int> choose(const test::MarkerPair& pair) {
  std::vector<int> branches(6, 0);
  bushing().choose_branches(pair.instant(), branches);
  return branches;
}

test::MarkerPair random_pair(test::RandomNumbers& random) {
  test::MarkerPair pair;
  for (dynamics::MarkerState& marker : pair.markers) {
    marker.r = {random.between(-0.1, 0.1), random.between(-0.1, 0.1)};
    marker.v = {random.between(-2.0, 2.0), random.between(-2.0, 2.0)};
    marker.angle = random.between(-3.0, 3.0);
    marker.omega = random.between(-2.0, 2.0);
  }
  return pair;
}

}  // namespace

TEST_CASE("A bushing opposes the position and the angle of b as seen from a", "[forces]") {
  // a is turned so that the axis x points to the world's +y: the bushing's y is the world's −x.
  test::MarkerPair pair;
  pair.markers[0].r = {1.0, 2.0};
  pair.markers[0].angle = std::acos(0.0) - 0.4;
  pair.markers[1].r = {0.9, 2.05};  // as seen from a: x 0.05, y 0.1
  pair.markers[1].angle = pair.markers[0].angle + 0.3;
  pair.markers[1].v = {-0.5, 0.25};
  pair.markers[1].omega = 2.0;
  std::vector<Wrench> wrenches(2);
  const dynamics::Power power = bushing().add_wrenches(pair.instant(), choose(pair), wrenches);
  // By hand: u = (0.03, 0.13, 0.2), u̇ = (0.25, 0.5, 2).
  const double x = -2.0 * (3.0 + 500.0 * 0.03 + 70.0 * 0.0009 + 8.0 * 0.25);
  const double y = -2.0 * (900.0 * 0.13 + 7.0 * 0.5), torque = -2.0 * (20.0 * 0.2 + 0.5 * 2.0);
  CHECK(wrenches[1].force.x() == Approx(-y).epsilon(1e-13));
  CHECK(wrenches[1].force.y() == Approx(x).epsilon(1e-13));
  CHECK(wrenches[1].torque == Approx(torque).epsilon(1e-13));
  CHECK((wrenches[0].force + wrenches[1].force).norm() == 0.0);
  // Both together exert no torque: about a's point.
  const double couple =
      wrenches[0].torque + wrenches[1].torque - 0.1 * wrenches[1].force.y() - 0.05 * wrenches[1].force.x();
  CHECK(std::abs(couple) < 1e-12);
  CHECK(power.dissipated == Approx(2.0 * (8.0 * 0.0625 + 7.0 * 0.25 + 0.5 * 4.0)).epsilon(1e-13));

  std::array<double, 9> values{};
  REQUIRE(bushing().channels().size() == 9);
  bushing().calc_channels(pair.instant(), choose(pair), values);
  const std::array expected{0.03, 0.13, 0.2, 0.25, 0.5, 2.0, x, y, torque};
  for (std::size_t i = 0; i < 9; ++i) CHECK(values[i] == Approx(expected[i]).epsilon(1e-12));
}

TEST_CASE("A bushing's stored and dissipated energy are what its points give, whatever their motion",
          "[forces]") {
  test::RandomNumbers random(35);
  for (int i = 0; i < 200; ++i) {
    const test::MarkerPair pair = random_pair(random);
    CHECK(std::abs(test::calc_energy_leak(bushing(), pair, choose(pair))) < kDifferences);
  }
}

TEST_CASE("A bushing's switches are the ends of its laws' pieces", "[forces]") {
  test::MarkerPair pair;
  pair.markers[0].angle = -0.4;
  const auto switches = [&](double y, double rate, const std::vector<int>& branches) {
    pair.markers[1].r = {0.0, y - 0.03};
    pair.markers[1].v = {0.0, rate};
    std::vector<double> values(static_cast<std::size_t>(bushing().num_switches()));
    bushing().calc_switches(pair.instant(), branches, values);
    return values;
  };
  pair.markers[1].r = {0.0, 0.02};
  pair.markers[1].v = {0.0, 0.5};
  const std::vector<int> branches = choose(pair);
  REQUIRE(bushing().num_switches() == 4);
  for (const double value : switches(0.05, 0.5, branches)) CHECK(value > 0.0);
  CHECK(switches(-0.01, 0.5, branches)[0] == Approx(-0.01).epsilon(1e-6));
  CHECK(switches(0.05, -0.2, branches)[2] == Approx(-0.2).epsilon(1e-4));
}

TEST_CASE("A part of a bushing that relaxes stores and dissipates what its points give", "[forces]") {
  test::RandomNumbers random(36);
  Bushing::Parameters parameters{.marker_a = 0, .marker_b = 1, .multiplicity = 2.0};
  parameters.directions[0] = {.relaxing_stiffness = 800.0, .relaxation_time = 0.02};
  parameters.directions[2] = {.relaxing_stiffness = 30.0, .relaxation_time = 0.5};
  const Bushing relaxing("mount", parameters);
  REQUIRE(relaxing.internal_states().size() == 2);
  CHECK(relaxing.internal_states()[0].name == "relaxation_x");
  CHECK(relaxing.internal_states()[1].name == "relaxation_rotation");
  for (int i = 0; i < 100; ++i) {
    test::MarkerPair pair = random_pair(random);
    pair.states = {random.between(-5.0, 5.0), random.between(-5.0, 5.0)};
    CHECK(std::abs(test::calc_energy_leak(relaxing, pair, std::vector<int>(6, 0))) < kDifferences);
  }
  // Held at a deflection, the force falls to 1/e after the relaxation time: ż = −z/τ.
  test::MarkerPair still;
  still.states = {3.0, -2.0};
  std::array<double, 2> rates{};
  relaxing.calc_state_rates(still.instant(), {}, rates);
  CHECK(rates[0] == Approx(-3.0 / 0.02).epsilon(1e-14));
  CHECK(rates[1] == Approx(2.0 / 0.5).epsilon(1e-14));
  // The force of a spring of 2·800 N/m that is deflected by e, where z = √1600 e.
  std::array<double, 9> channels{};
  relaxing.calc_channels(still.instant(), std::vector<int>(6, 0), channels);
  CHECK(channels[6] == Approx(-1600.0 * 3.0 / 40.0).epsilon(1e-14));
}
