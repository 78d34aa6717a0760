// The time until a road ceases to act on the truck.
#include <cmath>

#include "dynamics/mode_choice/forcing_spectrum.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/truck.h"

using namespace sprung;
using dynamics::BumpRoad;
using dynamics::BumpShape;

TEST_CASE("The forcing lasts until the last wheel has left the road's last feature", "[choice][truck]") {
  const test::TruckAtRest truck(0);
  const dynamics::LinearVehicle vehicle(truck.model, truck.equilibrium.q);
  REQUIRE(vehicle.inputs().size() == 2);
  const double behind = std::abs(vehicle.inputs()[0].distance - vehicle.inputs()[1].distance);
  CHECK(behind == Approx(4.35).epsilon(1e-3));  // between the axles
  const auto calc_duration = [&](const dynamics::Road& road, double duration) {
    return dynamics::calc_forcing_duration(vehicle, {.road = &road, .speed = 4.0, .duration = duration}, 0.5);
  };
  const BumpRoad bump({.shape = BumpShape::kHalfSine, .start = 1.0, .length = 0.4, .height = 0.2});
  CHECK(calc_duration(bump, 9.0) == Approx((1.4 + behind) / 4.0));
  CHECK(calc_duration(bump, 1.0) == 1.0);  // the run is over before
  const BumpRoad ramp({.shape = BumpShape::kRamp, .start = 1.0, .length = 0.4, .height = 0.2});
  CHECK(calc_duration(ramp, 9.0) ==
        Approx((1.4 + behind) / 4.0 +
               0.5));  // the road ends higher than it began: the vehicle needs time to come to rest
  CHECK(calc_duration(dynamics::FlatRoad(), 9.0) == Approx(behind / 4.0));
}
