#include "dynamics/forces/air_spring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/forces/force_motion.h"

using namespace sprung;
using dynamics::AirSpring;
using dynamics::PiecewisePolynomial;
using dynamics::PolytropicGas;
using dynamics::Wrench;
using Eigen::Vector2d;

namespace {

constexpr double kDifferences = 1e-6;  // relative error of the differences in time

// Area 0.05 m² at the design height of 0.3 m, falling by 0.1 m²/m.
AirSpring::Parameters plain() {
  AirSpring::Parameters p;
  p.markers = {0, 1, 2, 3};
  p.multiplicity = 2.0;
  p.design_height = 0.3;
  p.volume = 0.014;
  p.effective_area = PiecewisePolynomial::through_points(std::array{0.2, 0.4}, std::array{0.06, 0.04});
  p.pressure = 6.0e5;
  return p;
}

AirSpring::Parameters with_all() {
  AirSpring::Parameters p = plain();
  p.is_coupled = true;
  p.line_area = 2e-5;
  p.auxiliary_volume = 0.02;
  p.auxiliary_area = 5e-5;
  p.levelling = AirSpring::Levelling{
      .dead_band = 0.003, .full_opening = 0.02, .delay = 0.5, .supply_pressure = 9e5, .area = 3e-6};
  return p;
}

// Each bellows of a spring at a height, with a rate of its height.
test::MarkerPair place(const AirSpring& spring, std::array<double, 2> heights, std::array<double, 2> rates) {
  test::MarkerPair pair;
  pair.markers.resize(spring.markers().size());
  for (std::size_t i = 0; 2 * i < pair.markers.size(); ++i) {
    const double angle = 0.7 + 0.4 * static_cast<double>(i);
    const Vector2d direction(std::cos(angle), std::sin(angle));
    dynamics::MarkerState &a = pair.markers[2 * i], &b = pair.markers[2 * i + 1];
    a.r = {3.0, -2.0};
    a.v = {0.7, 1.9};
    b.r = a.r + heights[i] * direction;
    b.v = a.v + rates[i] * direction;
  }
  pair.states.resize(spring.internal_states().size());
  return pair;
}

// A valve that has followed the height.
void follow(const AirSpring& spring, test::MarkerPair& pair, double height) {
  pair.states.back() = spring.internal_states().back().size * (0.3 - height) / 0.003;  // of the dead band
}

std::vector<int> choose(const AirSpring& spring, const test::MarkerPair& pair) {
  std::vector<int> branches(static_cast<std::size_t>(spring.num_branches()), 0);
  spring.choose_branches(pair.instant(), branches);
  return branches;
}

double calc_force(const AirSpring& spring, double height) {
  const test::MarkerPair pair = place(spring, {height, 0.3}, {});
  std::vector<Wrench> wrenches(pair.markers.size());
  spring.add_wrenches(pair.instant(), choose(spring, pair), wrenches);
  CHECK((wrenches[0].force + wrenches[1].force).norm() < 1e-9);
  return wrenches[1].force.dot(Vector2d(std::cos(0.7), std::sin(0.7)));
}

}  // namespace

TEST_CASE(
    "An air spring's force is gauge pressure times area, and its stiffness that of the gas and the area",
    "[forces]") {
  const AirSpring spring("air", plain());
  CHECK(calc_force(spring, 0.3) == Approx(2.0 * (6.0e5 - 101325.0) * 0.05).epsilon(1e-12));
  // n p A²/V − p_gauge dA/dh, by hand.
  const double stiffness = 2.0 * (1.3 * 6.0e5 * 0.05 * 0.05 / 0.014 + (6.0e5 - 101325.0) * 0.1);
  constexpr double kStep = 1e-5;
  CHECK((calc_force(spring, 0.3 - kStep) - calc_force(spring, 0.3 + kStep)) / (2.0 * kStep) ==
        Approx(stiffness).epsilon(1e-6));
  // Squeezed by 0.08 m: A = 0.058, V = 0.014 − 0.08·0.054, p Vⁿ is constant.
  const double volume = 0.014 - 0.08 * 0.054, pressure = 6.0e5 * std::pow(0.014 / volume, 1.3);
  CHECK(calc_force(spring, 0.22) == Approx(2.0 * (pressure - 101325.0) * 0.058).epsilon(1e-12));
}

TEST_CASE("An air spring with an auxiliary volume at equal pressure has the stiffness of both volumes",
          "[forces]") {
  AirSpring::Parameters p = plain();
  p.effective_area = PiecewisePolynomial({0.05});
  p.auxiliary_volume = 0.02;
  p.auxiliary_area = 5e-5;
  const AirSpring spring("air", p);
  constexpr double kStep = 1e-5;
  CHECK((calc_force(spring, 0.3 - kStep) - calc_force(spring, 0.3 + kStep)) / (2.0 * kStep) ==
        Approx(2.0 * 1.3 * 6.0e5 * 0.05 * 0.05 / 0.034).epsilon(1e-6));
}

TEST_CASE(
    "An air spring's stored, dissipated and given energy are what its points give, in any state of its gas",
    "[forces]") {
  test::RandomNumbers random(41);
  AirSpring::Parameters isothermal = with_all();
  isothermal.exponent = 1.0;
  int filling = 0, venting = 0;
  for (const AirSpring& spring :
       {AirSpring("plain", plain()), AirSpring("all", with_all()), AirSpring("all", isothermal)}) {
    for (int i = 0; i < 100; ++i) {
      test::MarkerPair pair = place(spring, {random.between(0.15, 0.45), random.between(0.15, 0.45)},
                                    {random.between(-1.0, 1.0), random.between(-1.0, 1.0)});
      const std::vector<dynamics::InternalState> states = spring.internal_states();
      for (std::size_t k = 0; k < states.size(); ++k)
        pair.states[k] = random.between(-1.0, 1.0) * states[k].size * (states[k].name == "valve" ? 7.0 : 1.0);
      const std::vector<int> branches = choose(spring, pair);
      CHECK(std::abs(test::calc_energy_leak(spring, pair, branches)) < kDifferences);
      std::vector<Wrench> wrenches(pair.markers.size());
      const dynamics::Power power = spring.add_wrenches(pair.instant(), branches, wrenches);
      CHECK(power.dissipated >= 0.0);
      CHECK(power.input >= 0.0);
      filling += power.input > 0.0;
      venting += power.input == 0.0;
    }
  }
  CHECK(filling > 10);
  CHECK(venting > 10);
}

TEST_CASE("At rest with equal pressures the states of an air spring rest, at every height", "[forces]") {
  AirSpring::Parameters p = with_all();
  p.levelling.reset();
  const AirSpring spring("air", p);
  const test::MarkerPair pair = place(spring, {0.24, 0.37}, {});
  std::vector<double> rates(pair.states.size(), 1.0);
  spring.calc_state_rates(pair.instant(), choose(spring, pair), rates);
  for (const double rate : rates) CHECK(rate == 0.0);
  std::vector<double> values(spring.channels().size());
  spring.calc_channels(pair.instant(), choose(spring, pair), values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    CAPTURE(spring.channels()[i].name);
    if (spring.channels()[i].name.ends_with("difference")) CHECK(std::abs(values[i]) < 1e-6);
  }
  CHECK(values[3] / values[9] == Approx((0.06 - 0.04 * 0.1) / (0.04 + 0.03 * 0.1)).epsilon(1e-12));
}

TEST_CASE("A levelling valve is closed in its dead band, fills below it, and vents above it", "[forces]") {
  const AirSpring spring("air", with_all());
  const auto flow = [&](double height) {
    test::MarkerPair pair = place(spring, {height, 0.3}, {});
    follow(spring, pair, height);
    std::vector<double> values(spring.channels().size());
    spring.calc_channels(pair.instant(), choose(spring, pair), values);
    CHECK(spring.channels()[values.size() - 1].name == "valve_flow");
    return values.back();
  };
  CHECK(flow(0.298) == 0.0);
  CHECK(flow(0.302) == 0.0);
  CHECK(flow(0.29) > 0.0);
  CHECK(flow(0.31) < 0.0);
  CHECK(flow(0.27) > flow(0.29));
  // It follows with its time constant of 0.5 s.
  const test::MarkerPair lower = place(spring, {0.29, 0.3}, {});
  std::vector<double> rates(lower.states.size());
  spring.calc_state_rates(lower.instant(), choose(spring, lower), rates);
  CHECK(rates.back() == Approx(spring.internal_states().back().size * 0.01 / 0.003 / 0.5).epsilon(1e-9));
  // Vented to less than 0.528 of its pressure the flow is sonic: 0.685 A √(p ρ), two side by side, with the
  // pressure at this height and ρ = p_0/(R T) at the design height.
  const double volume = 0.014 + 0.02 * (0.05 + 0.048) / 2.0, total = 0.014 + 0.02 + 0.014 + 0.02;
  const double shrunk = total / (total - 0.014 + volume);
  const double pressure = 6.0e5 * std::pow(shrunk, 1.3), density = 6.0e5 / (287.05 * 293.15) * shrunk;
  CHECK(flow(0.32) == Approx(-2.0 * 0.6847 * 3e-6 * std::sqrt(pressure * density)).epsilon(1e-4));
}

TEST_CASE("Air flows through an orifice as an ideal gas through a nozzle", "[forces]") {
  const PolytropicGas gas(1.4, 6.0e5, 1.0e5, 300.0);
  const double density = 6.0e5 / (287.05 * 300.0), x = gas.density_at(6.0e5);
  CHECK(gas.pressure(x) == Approx(6.0e5).epsilon(1e-12));
  CHECK(gas.ambient_density() * x == Approx(density).epsilon(1e-12));
  for (const double ratio : {0.2, 0.5, 0.6, 0.8, 0.95}) {
    // Saint-Venant and Wantzel; the ellipse of ISO 6358 is within 1 % of it.
    const double r = std::max(ratio, std::pow(2.0 / 2.4, 1.4 / 0.4));
    const double nozzle =
        1e-4 * std::sqrt(6.0e5 * density * 7.0 * (std::pow(r, 2.0 / 1.4) - std::pow(r, 2.4 / 1.4)));
    CAPTURE(ratio);
    CHECK(gas.mass_flow(1e-4, x, gas.density_at(ratio * 6.0e5)) == Approx(nozzle).epsilon(0.01));
    CHECK(gas.mass_flow(1e-4, gas.density_at(ratio * 6.0e5), x) == Approx(-nozzle).epsilon(0.01));
  }
  CHECK(gas.mass_flow(1e-4, x, x) == 0.0);
}

TEST_CASE("The energy of a gas is the work of its expansion to ambient pressure", "[forces]") {
  for (const double n : {1.0, 1.000001, 1.3}) {
    const PolytropicGas gas(n, 6.0e5, 1.0e5, 300.0);
    // ∫ (p − p_a) dv from the density ρ_a x to ρ_a, by the midpoint rule in x.
    double work = 0.0;
    constexpr int kSteps = 20000;
    const double most = 4.0, width = (most - 1.0) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double x = 1.0 + (i + 0.5) * width;
      work += (gas.pressure(x) - 1.0e5) / (gas.ambient_density() * x * x) * width;
    }
    CHECK(gas.energy(most) == Approx(work).epsilon(1e-7));
    CHECK(gas.energy(1.0) == Approx(0.0).margin(1e-6));
  }
}

TEST_CASE("An orifice is linearised as it is near rest for small motion, and for large motion by its mean",
          "[forces]") {
  AirSpring::Parameters p = plain();
  p.multiplicity = 1.0;
  p.auxiliary_volume = 0.02;
  p.auxiliary_area = 5e-5;
  const AirSpring spring("air", p);
  const test::MarkerPair pair = place(spring, {0.3, 0.3}, {});
  const std::vector<int> branches = choose(spring, pair);
  std::vector<double> rms(spring.channels().size(), 0.0);
  const auto decay = [&](double difference) {
    rms[5] = difference;
    return spring.linearise_for_random_motion(pair.instant(), branches, rms).states->decay(0, 0);
  };
  // Near rest by differences of the law.
  test::MarkerPair moved = pair;
  moved.states[0] = 1e-5 * spring.internal_states()[0].size;
  std::array<double, 1> rates{};
  spring.calc_state_rates(moved.instant(), branches, rates);
  CHECK(decay(1.0) == Approx(-rates[0] / moved.states[0]).epsilon(1e-4));
  // Above the linear part the flow is that of a square root, for which ⟨|w|^{3/2}⟩ = 2^{3/4} Γ(5/4)/√π
  // σ^{3/2}.
  const double w = 0.02;
  moved.states[0] = w * spring.internal_states()[0].size / 0.05;
  spring.calc_state_rates(moved.instant(), branches, rates);
  const double mean = std::pow(2.0, 0.75) * std::tgamma(1.25) / std::sqrt(std::numbers::pi);
  CHECK(decay(w * 1.3 * 6.0e5) == Approx(-rates[0] / moved.states[0] * mean).epsilon(0.03));
}

TEST_CASE("An air spring's switches are the ends of the pieces of its valve's opening", "[forces]") {
  const AirSpring spring("air", with_all());
  const auto least = [&](double height, const std::vector<int>& branches) {
    std::vector<double> values(static_cast<std::size_t>(spring.num_switches()));
    test::MarkerPair pair = place(spring, {height, 0.3}, {});
    follow(spring, pair, height);
    spring.calc_switches(pair.instant(), branches, values);
    return *std::min_element(values.begin(), values.end());
  };
  const std::vector<int> branches = choose(spring, place(spring, {0.3, 0.3}, {}));
  REQUIRE(branches.size() == 1);
  REQUIRE(spring.num_switches() == 2);
  CHECK(least(0.3, branches) > 0.0);
  CHECK(least(0.296, branches) < 0.0);
  CHECK(least(0.304, branches) < 0.0);
}
