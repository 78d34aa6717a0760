#include "dynamics/forces/rotational_spring_damper.h"

#include <array>

#include "tests/catch.h"

using namespace sprung;
using dynamics::MarkerState;
using dynamics::PiecewisePolynomial;
using dynamics::RotationalSpringDamper;

namespace {

struct Pair {
  std::array<MarkerState, 2> markers;
  Pair(double angle_a, double omega_a, double angle_b, double omega_b) {
    markers[0].angle = angle_a;
    markers[0].omega = omega_a;
    markers[1].angle = angle_b;
    markers[1].omega = omega_b;
    markers[1].r = {3.0, 4.0};  // where the markers are does not matter
  }
  dynamics::Instant instant() const { return {0.0, markers}; }
};

RotationalSpringDamper make(PiecewisePolynomial spring, PiecewisePolynomial damper) {
  return RotationalSpringDamper("hinge", {.marker_a = 0,
                                          .marker_b = 1,
                                          .free_angle = 0.5,
                                          .multiplicity = 3.0,
                                          .spring = std::move(spring),
                                          .damper = std::move(damper)});
}

}  // namespace

TEST_CASE("A rotational spring turns its markers towards the free angle, its damper against their turning",
          "[forces]") {
  const RotationalSpringDamper element =
      make(PiecewisePolynomial({0.0, 40.0, 5.0}), PiecewisePolynomial({0.0, 2.0}));
  const Pair pair(0.2, -1.0, 0.4, 0.5);  // deflection 0.5 − 0.2 = 0.3, its rate −1.5
  std::array<int, 2> branches{};
  element.choose_branches(pair.instant(), branches);
  std::array<dynamics::Wrench, 2> wrenches;
  const dynamics::Power power = element.add_wrenches(pair.instant(), branches, wrenches);
  const double spring = 3.0 * (40.0 * 0.3 + 5.0 * 0.09), damper = 3.0 * 2.0 * -1.5;
  CHECK(wrenches[1].torque == Approx(spring + damper).epsilon(1e-14));
  CHECK(wrenches[0].torque == Approx(-spring - damper).epsilon(1e-14));
  CHECK(wrenches[0].force.isZero(0.0));
  CHECK(power.dissipated == Approx(damper * -1.5).epsilon(1e-14));
  // ∫ (40 d + 5 d²) dd
  CHECK(element.calc_stored_energy(pair.instant(), branches) ==
        Approx(3.0 * (20.0 * 0.09 + 5.0 * 0.027 / 3.0)).epsilon(1e-14));
  std::array<double, 4> channels{};
  element.calc_channels(pair.instant(), branches, channels);
  CHECK(channels[0] == Approx(0.2).epsilon(1e-14));
  CHECK(channels[3] == Approx(spring + damper).epsilon(1e-14));
}

TEST_CASE("A stop of a rotational spring is a switch", "[forces]") {
  PiecewisePolynomial spring({0.0, 40.0});
  spring.continue_straight(0.25, 900.0, false);
  const RotationalSpringDamper element = make(std::move(spring), PiecewisePolynomial());
  std::array<int, 2> branches{};
  element.choose_branches(Pair(0.0, 0.0, 0.3, 0.0).instant(), branches);
  CHECK(branches[0] == 0);
  std::array<double, 4> switches{};
  element.calc_switches(Pair(0.0, 0.0, 0.3, 0.0).instant(), branches, switches);
  CHECK(switches[1] == Approx(0.05).epsilon(1e-6));  // to a deflection of 0.25
  element.choose_branches(Pair(0.0, 0.0, 0.2, 0.0).instant(), branches);
  CHECK(branches[0] == 1);
}
