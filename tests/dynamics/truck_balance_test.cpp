// The truck at rest: published and independently calculated numbers of the reference vehicle.
#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/linear/vehicle_modes.h"
#include "dynamics/output/moving_bodies.h"
#include "tests/catch.h"
#include "tests/dynamics/random_numbers.h"
#include "tests/dynamics/truck.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;

namespace {

std::vector<double> frequencies(const test::TruckAtRest& truck) {
  std::vector<double> found;
  for (const dynamics::VehicleMode& mode : dynamics::calc_vehicle_modes(truck.model, truck.equilibrium)) {
    if (!mode.is_rigid_body) found.push_back(mode.undamped_frequency_hz);
  }
  return found;
}

double chassis_height(const dynamics::Model& model, const Eigen::VectorXd& q) {
  return q[model.bodies[static_cast<std::size_t>(model.find_body("chassis"))].first_coordinate + 1];
}

// To the four digits that the reference gives: within half of the last, which is `unit` [Hz].
void check_frequency(double found, double expected, double unit) {
  INFO(found << " Hz against " << expected << " Hz");
  CHECK(std::abs(found - expected) <= 0.5 * unit);
}

}  // namespace

TEST_CASE("The truck's equilibrium is within 1 mm of the printed height", "[truck]") {
  // [Kim, Shabana & Haug 1983], Table 2: chassis at 0.975 m, axles at 0.575 m, front and rear alike
  for (const int num_modes : {0, 2, 4}) {
    const test::TruckAtRest truck(num_modes);
    INFO(num_modes << " chassis modes");
    CHECK(std::abs(truck.chassis()[1] - 0.975) < 1e-3);
    CHECK(std::abs(truck.chassis()[2]) < 1e-9);
    CHECK(std::abs(truck.equilibrium.q[truck.model.bodies[0].first_coordinate + 1] - 0.575) < 1e-3);
    CHECK(truck.equilibrium.stable);
  }
}

TEST_CASE("In equilibrium the tyres carry the whole weight, half of it each axle", "[truck]") {
  const test::TruckAtRest truck(2);
  double mass = 0.0;
  for (const dynamics::Body& body : truck.model.bodies) mass += body.mass;
  // Two tyres per axle, F = 5.649e7 δ² each (Table 1), penetration δ = 0.6 m − height of the axle
  for (const char* axle : {"front_axle", "rear_axle"}) {
    const int b = truck.model.find_body(axle);
    const double y =
        truck.equilibrium.q[truck.model.bodies[static_cast<std::size_t>(b)].first_coordinate + 1];
    CHECK(2.0 * 5.649e7 * std::pow(0.6 - y, 2) == Approx(0.5 * mass * 9.80665).epsilon(1e-9));
  }
}

TEST_CASE("The truck is neutral along x, and its freedoms are 5, 7 and 9", "[truck]") {
  for (const int num_modes : {0, 2, 4}) {
    const test::TruckAtRest truck(num_modes);
    CHECK(truck.model.num_freedoms() == 5 + num_modes);
    REQUIRE(truck.equilibrium.neutral.size() == 1);
    CHECK(truck.equilibrium.neutral[0].description == "all bodies along x");
    // It keeps its value there, for any forces on the way to the equilibrium.
    const Eigen::VectorXd start = test::assemble_truck(truck.model, truck.vehicle);
    const int chassis =
        truck.model.bodies[static_cast<std::size_t>(truck.model.find_body("chassis"))].first_coordinate;
    CHECK(truck.chassis()[0] == Approx(start[chassis]).margin(1e-9));
    const std::vector<dynamics::VehicleMode> modes =
        dynamics::calc_vehicle_modes(truck.model, truck.equilibrium);
    REQUIRE(modes.size() == static_cast<std::size_t>(5 + num_modes));
    CHECK(modes[0].is_rigid_body);
    CHECK(modes[0].undamped_frequency_hz == 0.0);
    CHECK_FALSE(modes[1].is_rigid_body);
  }
}

// The mode at 9.67 Hz is the first bending of the chassis on its axles; the other words follow from the
// motions that are put in, by their energies m v² and J ω² about the centre of mass.
TEST_CASE("Who moves in a mode of the truck stands in words", "[truck]") {
  const test::TruckAtRest truck(2);
  const auto modes = dynamics::calc_vehicle_modes(truck.model, truck.equilibrium);
  const auto describe = [&](const dynamics::VehicleMode& mode) {
    return dynamics::describe_moving_bodies(truck.model, truck.vehicle, mode);
  };
  CHECK_THAT(describe(modes[3]), Catch::Matchers::StartsWith("chassis bending, 95 %"));
  CHECK_THAT(describe(modes[0]), Catch::Matchers::StartsWith("chassis fore-aft, "));
  const int chassis = truck.model.find_body("chassis"), axle = truck.model.find_body("front_axle");
  REQUIRE(std::min(chassis, axle) >= 0);
  const dynamics::Body& body = truck.model.bodies[static_cast<std::size_t>(chassis)];
  const double radius =
      std::sqrt(body.second_moment / body.mass - body.first_moment.squaredNorm() / (body.mass * body.mass));
  dynamics::VehicleMode mode;
  mode.participants = {{.body = chassis, .share = 0.6, .motion = {0.0, 1.0, 1.1 / radius}},
                       {.body = axle, .share = 0.4, .motion = {0.1, 1.0, 0.0}}};
  CHECK(describe(mode) == "chassis pitch and heave, 60 %; front_axle hop, 40 %");
  mode.participants = {{.body = chassis, .share = 1.0, .motion = {0.0, 0.5, 1.0 / radius}}};
  CHECK(describe(mode) == "chassis pitch, 100 %");
}

// Expected frequencies: an independent calculation with the same data, undamped, linearised about static
// balance.
TEST_CASE("Frequencies of the rigid truck", "[truck]") {
  const std::vector<double> found = frequencies(test::TruckAtRest(0));
  REQUIRE(found.size() == 4);
  check_frequency(found[0], 1.940, 1e-3);
  check_frequency(found[1], 1.952, 1e-3);
  check_frequency(found[2], 11.44, 1e-2);
  check_frequency(found[3], 11.51, 1e-2);
}

TEST_CASE("Frequencies of the truck with 2 chassis modes", "[truck]") {
  const std::vector<double> found = frequencies(test::TruckAtRest(2));
  REQUIRE(found.size() == 6);
  check_frequency(found[0], 1.939, 1e-3);
  check_frequency(found[1], 1.952, 1e-3);
  check_frequency(found[2], 9.666, 1e-3);
  check_frequency(found[3], 11.49, 1e-2);
  check_frequency(found[4], 11.51, 1e-2);
  check_frequency(found[5], 35.0, 1e-1);
}

TEST_CASE("Frequencies of the truck with 4 chassis modes", "[truck]") {
  const std::vector<double> found = frequencies(test::TruckAtRest(4));
  REQUIRE(found.size() == 8);
  check_frequency(found[0], 1.936, 1e-3);
  check_frequency(found[1], 1.950, 1e-3);
  check_frequency(found[2], 9.574, 1e-3);
  check_frequency(found[3], 11.48, 1e-2);
  check_frequency(found[4], 11.51, 1e-2);
  check_frequency(found[5], 26.51, 1e-2);
  check_frequency(found[6], 54.09, 1e-2);
  check_frequency(found[7], 127.0, 1e-1);
}

TEST_CASE("With all 36 modes the chassis frequencies converge", "[truck]") {
  const std::vector<double> found = frequencies(test::TruckAtRest(36));
  REQUIRE(found.size() == 40);
  check_frequency(found[2], 9.568, 1e-3);
  check_frequency(found[5], 26.463, 1e-3);
  check_frequency(found[6], 52.642, 1e-3);
}

TEST_CASE("The suspension's damper counts with the mean of its two slopes", "[truck]") {
  // A damper of one slope, the mean of 5480 and 17575 N·s/m, has the same linearisation.
  const test::TruckAtRest truck(0);
  const dynamics::Vehicle vehicle = test::read_truck({"forces.front_suspension.damper={coefficient=11527.5}",
                                                      "forces.rear_suspension.damper={coefficient=11527.5}"});
  const dynamics::PlacedRoad road =
      dynamic_cast<const dynamics::PointContactTyre&>(*truck.model.forces.back()).road();
  const dynamics::Model one_slope = test::make_truck(vehicle, 0, road);
  const dynamics::Equilibrium equilibrium = dynamics::find_equilibrium(one_slope, truck.equilibrium.q);
  const Eigen::MatrixXd& expected = equilibrium.linearised.damping;
  CHECK((truck.equilibrium.linearised.damping - expected).norm() < 1e-6 * expected.norm());
  const std::vector<dynamics::VehicleMode> modes =
      dynamics::calc_vehicle_modes(truck.model, truck.equilibrium);
  for (const dynamics::VehicleMode& mode : modes) CHECK((mode.is_rigid_body || mode.damping_ratio > 0.05));
}

TEST_CASE("A truck whose bodies are displaced by a centimetre is assembled, and has the same equilibrium",
          "[truck]") {
  const test::TruckAtRest truck(2);
  test::RandomNumbers random(4);
  Eigen::VectorXd q = dynamics::make_start_positions(truck.model, truck.vehicle);
  for (const dynamics::Body& body : truck.model.bodies) {
    q.segment<3>(body.first_coordinate) += random.vector(3, 0.01);
  }
  const dynamics::AssemblyReport report = dynamics::assemble_positions(truck.model, q);
  CHECK(report.residual < 1e-11);
  CHECK(report.largest_movement > 1e-3);
  CHECK(report.largest_movement < 0.05);
  const dynamics::Equilibrium rest = dynamics::find_equilibrium(truck.model, q);
  CHECK(chassis_height(truck.model, rest.q) == Approx(truck.chassis()[1]).margin(1e-9));
}

TEST_CASE("From 0.3 m above the ground the search finds the truck at rest on its wheels", "[truck]") {
  for (const int num_modes : {0, 4}) {
    const test::TruckAtRest truck(num_modes);
    Eigen::VectorXd q = test::assemble_truck(truck.model, truck.vehicle);
    for (const dynamics::Body& body : truck.model.bodies) q[body.first_coordinate + 1] += 0.3;
    const dynamics::Equilibrium rest = dynamics::find_equilibrium(truck.model, q);
    CHECK(chassis_height(truck.model, rest.q) == Approx(truck.chassis()[1]).margin(1e-9));
    CHECK(rest.neutral.size() == 1);
  }
}

TEST_CASE("A truck under upward gravity has no equilibrium", "[truck]") {
  const dynamics::Vehicle vehicle = test::read_truck({"gravity=[0.0, 9.8]"});
  const test::TruckAtRest truck(0);
  const dynamics::Model model = test::make_truck(
      vehicle, 0, dynamic_cast<const dynamics::PointContactTyre&>(*truck.model.forces.back()).road());
  CHECK_THROWS_AS(dynamics::find_equilibrium(model, truck.equilibrium.q), support::NumericalError);
}
