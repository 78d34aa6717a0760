#include "dynamics/forces/leaf_spring.h"

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "dynamics/forces/friction_loop.h"
#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::LeafSpring;
using dynamics::PiecewisePolynomial;
using dynamics::Wrench;
using Eigen::Vector2d;
using std::numbers::pi;

namespace {

// As for the spring-damper.
constexpr double kDifferences = 1e-7;

// Its friction rises from 200 N to 300 N over the deflections from 0 to 0.1 m. Two side by side; in its state
// 1 is √(2·300·0.02).
const LeafSpring& spring() {
  static const LeafSpring made = [] {
    PiecewisePolynomial friction =
        PiecewisePolynomial::through_points(std::array{0.0, 0.1}, std::array{200.0, 300.0});
    friction.continue_straight(0.1, 0.0, false);
    friction.continue_straight(0.0, 0.0, true);
    return LeafSpring("leaf", {.marker_a = 0,
                               .marker_b = 1,
                               .free_length = 1.0,
                               .multiplicity = 2.0,
                               .spring = PiecewisePolynomial({0.0, 5.0e3, 2.0e3}),
                               .friction = friction,
                               .presliding_deflection = 0.02});
  }();
  return made;
}
const double kFullState = std::sqrt(2.0 * 300.0 * 0.02);

test::MarkerPair place(double deflection, double rate, double share, double angle = 0.7) {
  const Vector2d direction(std::cos(angle), std::sin(angle)), across(-direction.y(), direction.x());
  test::MarkerPair pair;
  pair.markers[0].r = {3.0, -2.0};
  pair.markers[0].v = {0.7, 1.9};
  pair.markers[1].r = pair.markers[0].r + (1.0 - deflection) * direction;
  pair.markers[1].v = pair.markers[0].v - rate * direction + 2.3 * across;
  pair.states = {share * kFullState};
  return pair;
}

std::vector<int> choose(const test::MarkerPair& pair) {
  std::vector<int> branches(3, 0);
  spring().choose_branches(pair.instant(), branches);
  return branches;
}

double rate_of_share(double deflection, double rate, double share) {
  const test::MarkerPair pair = place(deflection, rate, share);
  std::array<double, 1> rates{};
  spring().calc_state_rates(pair.instant(), choose(pair), rates);
  return rates[0] / kFullState;
}

}  // namespace

TEST_CASE("A leaf spring pushes with its elastic force and the share of its friction that has built up",
          "[forces]") {
  const test::MarkerPair pair = place(0.05, 0.3, -0.4);
  std::vector<Wrench> wrenches(2);
  spring().add_wrenches(pair.instant(), choose(pair), wrenches);
  const double force = 2.0 * (5.0e3 * 0.05 + 2.0e3 * 0.0025 - 0.4 * 250.0);
  CHECK((wrenches[1].force - force * Vector2d(std::cos(0.7), std::sin(0.7))).norm() < 1e-9);
  CHECK(wrenches[0].force == -wrenches[1].force);
  std::array<double, 5> values{};
  spring().calc_channels(pair.instant(), choose(pair), values);
  CHECK(values[0] == Approx(0.95).epsilon(1e-12));
  CHECK(values[1] == Approx(0.05).epsilon(1e-12));
  CHECK(values[2] == Approx(0.3).epsilon(1e-12));
  CHECK(values[3] == Approx(force).epsilon(1e-12));
  CHECK(values[4] == Approx(-200.0).epsilon(1e-12));
}

TEST_CASE("A leaf spring's friction approaches its full value over the path, and keeps its value at rest",
          "[forces]") {
  // By (19): ṗ = (ḋ − |ḋ| p)/β.
  CHECK(rate_of_share(0.05, 0.3, -0.4) == Approx(0.3 * 1.4 / 0.02).epsilon(1e-12));
  CHECK(rate_of_share(0.05, -0.3, -0.4) == Approx(-0.3 * 0.6 / 0.02).epsilon(1e-12));
  CHECK(rate_of_share(0.05, 0.3, 1.0) == Approx(0.0).margin(1e-12));
  CHECK(rate_of_share(0.05, 0.0, 0.7) == Approx(0.0).margin(1e-12));
}

TEST_CASE("A leaf spring's stored and dissipated energy are what its points give, and it never gains energy",
          "[forces]") {
  test::RandomNumbers random(37);
  std::set<std::vector<int>> met;
  for (int i = 0; i < 200; ++i) {
    const test::MarkerPair pair = place(random.between(-0.2, 0.3), random.between(-2.0, 2.0),
                                        random.between(-1.0, 1.0), random.between(-3.0, 3.0));
    const std::vector<int> branches = choose(pair);
    met.insert(branches);
    CHECK(std::abs(test::calc_energy_leak(spring(), pair, branches)) < kDifferences);
    std::vector<Wrench> wrenches(2);
    CHECK(spring().add_wrenches(pair.instant(), branches, wrenches).dissipated >= 0.0);
  }
  CHECK(met.size() == 6);  // three pieces of friction, two directions
}

TEST_CASE("A leaf spring's switches are reversals and the ends of its laws' pieces", "[forces]") {
  const auto switches = [](const test::MarkerPair& pair, const std::vector<int>& branches) {
    std::vector<double> values(static_cast<std::size_t>(spring().num_switches()));
    spring().calc_switches(pair.instant(), branches, values);
    return values;
  };
  const std::vector<int> branches = choose(place(0.05, 0.3, 0.0));
  REQUIRE(spring().num_switches() == 3);
  for (const double value : switches(place(0.05, 0.3, 0.0), branches)) CHECK(value > 0.0);
  CHECK(switches(place(0.05, -0.1, 0.0), branches)[0] < 0.0);
  CHECK(switches(place(-0.01, 0.3, 0.0), branches)[1] < 0.0);
  CHECK(switches(place(0.11, 0.3, 0.0), branches)[2] < 0.0);
}

TEST_CASE(
    "The first harmonic of friction in a loop is that of a spring for small loops, of dry friction for "
    "large ones, and its work is that of the loop",
    "[forces]") {
  CHECK(dynamics::calc_friction_harmonic(1e-3).in_phase == Approx(1e-3).epsilon(1e-3));
  CHECK(dynamics::calc_friction_harmonic(1e-3).ahead == Approx(4.0 / pi * 1e-6 / 3.0).epsilon(1e-3));
  CHECK(dynamics::calc_friction_harmonic(1e4).ahead == Approx(4.0 / pi).epsilon(1e-3));
  // Integrated along (20) with A = 1, β = 1/x by steps of the path, from a corner to the other one.
  for (const double x : {0.3, 1.0, 4.0}) {
    double in_phase = 0.0, ahead = 0.0;
    double p = -std::tanh(x);
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double from = pi * (static_cast<double>(i) / kSteps - 0.5), to = from + pi / kSteps;
      const double middle = 0.5 * (from + to);
      const double half = 1.0 + (p - 1.0) * std::exp(-x * (std::sin(middle) - std::sin(from)));
      in_phase += 2.0 / kSteps * half * std::sin(middle);
      ahead += 2.0 / kSteps * half * std::cos(middle);
      p = 1.0 + (p - 1.0) * std::exp(-x * (std::sin(to) - std::sin(from)));
    }
    CHECK(p == Approx(std::tanh(x)).epsilon(1e-6));  // the loop closes
    CHECK(dynamics::calc_friction_harmonic(x).in_phase == Approx(in_phase).epsilon(1e-5));
    CHECK(dynamics::calc_friction_harmonic(x).ahead == Approx(ahead).epsilon(1e-5));
  }
}

TEST_CASE("Friction is linearised as a spring for small random motion, and as dry friction for large motion",
          "[forces]") {
  const dynamics::LinearFriction small = dynamics::linearise_friction(1e-6, 1e-5, 0.01);
  CHECK(small.gain == Approx(1.0).epsilon(1e-3));
  CHECK(small.decay < 1e-2);
  // p = g ḋ/(β λ), which for dry friction under Gaussian motion is √(2/π) ḋ/σ_ḋ.
  const dynamics::LinearFriction large = dynamics::linearise_friction(10.0, 20.0, 0.01);
  CHECK(large.gain * 20.0 / (0.01 * large.decay) == Approx(std::sqrt(2.0 / pi)).epsilon(2e-3));
}
