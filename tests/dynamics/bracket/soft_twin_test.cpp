#include "dynamics/bracket/soft_twin.h"

#include <fmt/format.h>

#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/truck.h"

namespace sprung::dynamics {
namespace {

TEST_CASE("a soft twin that does not tell its deflection at rest, from an earlier program, proves nothing") {
  Vehicle truck = test::read_truck({"bodies.chassis.superelement=\"chassis_certified\""});
  reduce::Superelement& chassis = truck.superelements.at("chassis_certified");
  const FlatRoad flat;
  const PlacedRoad road{&flat};
  const Model model = test::make_truck(truck, chassis.num_modes(), road);
  CHECK(make_soft_twin(truck, model).unproved.empty());
  chassis.certificate->soft_static_share.resize(0);
  CHECK(make_soft_twin(truck, model).unproved == std::vector<std::string>{"chassis"});
}

TEST_CASE("bodies without a bracket of their frequencies are refused with the reason") {
  Vehicle truck = test::read_truck({"bodies.chassis.superelement=\"chassis_certified\""});
  reduce::Superelement& chassis = truck.superelements.at("chassis_certified");
  const FlatRoad flat;
  const PlacedRoad road{&flat};
  const int all = chassis.num_modes();
  const Model with_all = test::make_truck(truck, all, road),
              with_few = test::make_truck(truck, all - 1, road);
  CHECK_THROWS_WITH(
      make_soft_twin(truck, with_few),
      Contains(fmt::format("body 'chassis' has no bracket of its frequencies: it has {} of {} modes; set "
                           "modes.chassis = \"certified\"",
                           all - 1, all)));
  chassis.certificate->soft_loads.resize(0, 0);
  CHECK_THROWS_WITH(make_soft_twin(truck, with_all), Contains("its certificate has no soft loads"));
  chassis.certificate.reset();
  CHECK_THROWS_WITH(make_soft_twin(truck, with_all), Contains("has no bound up to the end of its band"));
}

}  // namespace
}  // namespace sprung::dynamics
