#include "dynamics/forces/applied_force.h"

#include <array>

#include "tests/catch.h"

using namespace sprung;
using dynamics::AppliedForce;
using dynamics::MarkerState;
using dynamics::TimeFunction;
using Eigen::Vector2d;

TEST_CASE("An applied force stays with the world or follows its marker, and its work is put in", "[forces]") {
  std::array<MarkerState, 1> markers;
  markers[0].angle = 0.8;
  markers[0].v = {2.0, -1.0};
  markers[0].omega = 3.0;
  const dynamics::Instant instant{0.5, markers};
  for (const AppliedForce::Axes axes : {AppliedForce::Axes::kWorld, AppliedForce::Axes::kFollowing}) {
    const AppliedForce force("push", {.marker = 0,
                                      .axes = axes,
                                      .force_x = TimeFunction::polynomial({1.0, 4.0}),
                                      .force_y = TimeFunction(-2.0),
                                      .torque = TimeFunction::polynomial({0.0, 0.0, 8.0})});
    std::array<dynamics::Wrench, 1> wrenches;
    const dynamics::Power power = force.add_wrenches(instant, {}, wrenches);
    const Vector2d own(3.0, -2.0);  // 1 + 4 · 0.5, −2
    const Vector2d expected =
        axes == AppliedForce::Axes::kWorld ? own : dynamics::FrameRotation::from_angle(0.8) * own;
    CHECK((wrenches[0].force - expected).norm() < 1e-14);
    CHECK(wrenches[0].torque == 2.0);
    CHECK(power.input == Approx(expected.dot(markers[0].v) + 6.0).epsilon(1e-14));
    CHECK(power.dissipated == 0.0);
    CHECK(force.calc_stored_energy(instant, {}) == 0.0);
  }
}
