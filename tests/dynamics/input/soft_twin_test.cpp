#include "dynamics/input/soft_twin.h"

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

}  // namespace
}  // namespace sprung::dynamics
