#include <array>
#include <cmath>

#include "dynamics/input/make_model.h"
#include "dynamics/input/run.h"
#include "dynamics/system/system_terms.h"
#include "tests/catch.h"
#include "tests/dynamics/input/lumped_superelement.h"
#include "tools/support/toml/toml.h"

using namespace sprung;

namespace {

constexpr double kPrinted = 1e-3;  // Table 2 of Kim, Shabana & Haug (1983) prints metres to three decimals
constexpr double kClosed = 1e-12;  // the joints' own closure [m]

// Truck with bodies of point masses in place of the real superelements: nodes and their names are the same.
dynamics::Vehicle read_truck() {
  const std::filesystem::path folder = "truck_superelements";
  const double half = std::hypot(0.5, 0.25);
  test::write_lumped_superelement({.name = "chassis",
                                   .nodes = {{"", {0.0, 0.0}, 1e4},
                                             {"front_long_pivot", {-1.059, 0.0}},
                                             {"front_spring", {-2.175, 0.0}},
                                             {"front_short_pivot", {-3.034, 0.0}},
                                             {"rear_long_pivot", {1.059, 0.0}},
                                             {"rear_spring", {2.175, 0.0}},
                                             {"rear_short_pivot", {3.034, 0.0}}},
                                   .frequencies = {6.11, 6.11}},
                                  folder);
  test::write_lumped_superelement(
      {.name = "long_arm",
       .nodes = {{"middle", {0.0, 0.0}}, {"chassis_end", {half, 0.0}}, {"axle_end", {-half, 0.0}}},
       .frequencies = {88.92, 88.92}},
      folder);
  return dynamics::read_vehicle(support::TomlDocument::read(SPRUNG_MODELS "/truck/vehicle.toml"), folder);
}

struct TruckAtStart {
  dynamics::Vehicle vehicle = read_truck();
  dynamics::Run run = dynamics::read_run(support::TomlDocument::read(SPRUNG_MODELS "/truck/bump.toml"));
  std::unique_ptr<dynamics::Road> road = dynamics::make_road(run.road);
  dynamics::Model model =
      dynamics::make_model(vehicle, {}, {.road = road.get(), .direction = vehicle.direction, .origin = -1.5});
  dynamics::SystemTerms terms{model};

  TruckAtStart() { terms.update_positions(0.0, dynamics::make_start_positions(model, vehicle)); }

  Eigen::Vector2d at(const std::string& point) const {
    return terms.markers()[static_cast<std::size_t>(model.find_marker(point))].r;
  }
  double force_of(std::size_t index, std::size_t channel, const dynamics::MarkerState& a,
                  const dynamics::MarkerState& b) const;
};

// A channel of a force element of the truck, with its markers put where the test wants them.
double TruckAtStart::force_of(std::size_t index, std::size_t channel, const dynamics::MarkerState& a,
                              const dynamics::MarkerState& b) const {
  std::vector<dynamics::MarkerState> markers(model.markers.size());
  const std::vector<dynamics::PointReference>& points = vehicle.forces[index].points;
  markers[static_cast<std::size_t>(model.find_marker(points[0].name))] = a;
  if (points.size() > 1) markers[static_cast<std::size_t>(model.find_marker(points[1].name))] = b;
  const dynamics::ForceElement& force = *model.forces[index];
  std::vector<int> branches(static_cast<std::size_t>(force.num_branches()));
  const dynamics::Instant instant{.time = 0.0, .markers = markers};
  force.choose_branches(instant, branches);
  std::vector<double> values(force.channels().size());
  force.calc_channels(instant, branches, values);
  return values[channel];
}

// Force of one wheel's spring and damper.
double suspension_force(const TruckAtStart& truck, std::size_t index, double deflection, double rate) {
  dynamics::MarkerState a, b;
  b.r = {0.0, 0.458 - deflection};
  b.v = {0.0, -rate};
  return 0.5 * truck.force_of(index, 3, a, b);
}

// Force of one tyre on flat ground.
double tyre_force(const TruckAtStart& truck, std::size_t index, double penetration, double rate) {
  dynamics::MarkerState wheel;
  wheel.r = {5.0, 0.6 - penetration};
  wheel.v = {0.0, -rate};
  return 0.5 * truck.force_of(index, 0, wheel, {});
}

}  // namespace

TEST_CASE("The truck's bodies are those of Table 2") {
  struct Row {
    const char* name;
    double mass, inertia, x, y, angle;
  };
  const std::array<Row, 7> table{{{"front_axle", 1185, 13.33, 1.500, 0.575, 0},
                                  {"rear_axle", 1185, 13.33, 5.850, 0.575, 0},
                                  {"chassis", 0, 0, 3.675, 0.975, 0},
                                  {"front_long_arm", 0, 0, 2.116, 0.725, 0.464},
                                  {"rear_long_arm", 0, 0, 5.234, 0.725, -0.464},
                                  {"front_short_arm", 17.6, 1.14, 1.066, 0.909, -0.154},
                                  {"rear_short_arm", 17.6, 1.14, 6.284, 0.909, 0.154}}};
  const dynamics::Vehicle truck = read_truck();
  CHECK(truck.direction == -1.0);
  CHECK(truck.gravity == Eigen::Vector2d(0.0, -9.80665));
  REQUIRE(truck.bodies.size() == table.size());
  for (const Row& row : table) {
    CAPTURE(row.name);
    const dynamics::BodyDescription* body = truck.find_body(row.name);
    REQUIRE(body != nullptr);
    CHECK(body->mass == row.mass);  // 0: the superelement's
    CHECK(body->inertia == row.inertia);
    CHECK(body->position == Eigen::Vector2d(row.x, row.y));
    // A bar turned by half a turn lies on the same line.
    CHECK(std::abs(std::sin(body->angle - row.angle)) < kPrinted);
  }
}

TEST_CASE("The truck's arms join the axles' and the chassis' pivots") {
  const TruckAtStart truck;
  struct Joint {
    const char* name;
    Eigen::Vector2d pivot;
  };
  // From centroids, angles and half lengths of Table 2; chassis ends on the chassis axis, y = 0.975.
  const std::array<Joint, 8> joints{{{"front_long_chassis", {3.675 - 1.059, 0.975}},
                                     {"front_long_axle", {1.5 + 0.116, 0.575 - 0.1}},
                                     {"rear_long_chassis", {3.675 + 1.059, 0.975}},
                                     {"rear_long_axle", {5.85 - 0.116, 0.575 - 0.1}},
                                     {"front_short_chassis", {3.675 - 3.034, 0.975}},
                                     {"front_short_axle", {1.5 - 0.009, 0.575 + 0.268}},
                                     {"rear_short_chassis", {3.675 + 3.034, 0.975}},
                                     {"rear_short_axle", {5.85 + 0.009, 0.575 + 0.268}}}};
  REQUIRE(truck.model.joints.size() == joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const dynamics::JointDescription& joint = truck.vehicle.joints[j];
    CAPTURE(joint.name);
    CHECK(joint.name == joints[j].name);
    CHECK((truck.at(joint.a.name) - truck.at(joint.b.name)).norm() < kClosed);
    CHECK((truck.at(joint.a.name) - joints[j].pivot).norm() < kPrinted);
  }
  CHECK(truck.model.num_freedoms() == 5);  // text of the paper: a 5-DOF model
}

TEST_CASE("The truck is its own mirror image about the chassis") {
  const TruckAtStart truck;
  const std::array<std::array<const char*, 2>, 8> pairs{
      {{"front_axle.origin", "rear_axle.origin"},
       {"front_axle.long_arm", "rear_axle.long_arm"},
       {"front_axle.short_arm", "rear_axle.short_arm"},
       {"front_long_arm.origin", "rear_long_arm.origin"},
       {"front_long_arm.axle_end", "rear_long_arm.axle_end"},
       {"front_short_arm.origin", "rear_short_arm.origin"},
       {"front_short_arm.axle_end", "rear_short_arm.axle_end"},
       {"chassis.front_spring", "chassis.rear_spring"}}};
  for (const auto& [front, rear] : pairs) {
    CAPTURE(front);
    CHECK(truck.at(front).x() + truck.at(rear).x() == Approx(2.0 * 3.675).epsilon(1e-14));
    CHECK(truck.at(front).y() == Approx(truck.at(rear).y()).epsilon(1e-14));
  }
}

TEST_CASE("The truck's springs have the rates of Table 1") {
  const TruckAtStart truck;
  const double k0 = 4.67e5, k1 = 1.49e6, bump_rate = 6.91e6;
  for (const std::size_t index : {std::size_t{0}, std::size_t{1}}) {
    const auto spring = [&](double d) { return suspension_force(truck, index, d, 0.0); };
    // Progressive law k₀ d + k₁ d²/2 in tension and in compression, then the bump stop.
    for (const double d : {-0.03, 0.02, 0.09, 0.15}) {
      CHECK(spring(d) == Approx(k0 * d + 0.5 * k1 * d * d).epsilon(1e-12));
    }
    CHECK(spring(0.15) == Approx(8.681e4).epsilon(1e-4));
    CHECK(spring(0.17) == Approx(spring(0.15) + bump_rate * 0.02).epsilon(1e-12));
    const double h = 1e-6;  // slopes by differences; the law has no third derivative
    CHECK((spring(0.15) - spring(0.15 - 2.0 * h)) / (2.0 * h) == Approx(6.91e5).epsilon(1e-3));
    CHECK((spring(0.15 + h) - spring(0.15)) / h == Approx(6.91e6).epsilon(1e-6));
    // Under static load one wheel's spring and tyre in series give the printed 1.98 and 1.95 Hz.
    const double static_load = 11950.0 * 9.80665 / 4.0;
    const double d = (-k0 + std::sqrt(k0 * k0 + 2.0 * k1 * static_load)) / k1;
    const double tangent = (spring(d + h) - spring(d - h)) / (2.0 * h);
    const double series = 1.0 / (1.0 / tangent + 1.0 / 2.825e6);
    CHECK(std::sqrt(4.0 * series / 11950.0) / (2.0 * 3.14159265) == Approx(1.98).margin(0.005));
    CHECK(std::sqrt(4.0 * series * 2.175 * 2.175 / 58300.0) / (2.0 * 3.14159265) ==
          Approx(1.95).margin(0.005));
  }
}

TEST_CASE("The truck's dampers and tyres have the numbers of Table 1") {
  const TruckAtStart truck;
  for (const std::size_t index : {std::size_t{0}, std::size_t{1}}) {
    CHECK(suspension_force(truck, index, 0.0, 0.7) == Approx(5480.0 * 0.7).epsilon(1e-12));
    CHECK(suspension_force(truck, index, 0.0, -0.7) == Approx(-17575.0 * 0.7).epsilon(1e-12));
  }
  for (const std::size_t index : {std::size_t{2}, std::size_t{3}}) {
    CHECK(tyre_force(truck, index, 0.025, 0.1) ==
          Approx(5.649e7 * 0.025 * 0.025 + 4625.0 * 0.1).epsilon(1e-12));
    CHECK(tyre_force(truck, index, -0.01, 0.1) == 0.0);
    // The printed axle height is the radius less the static penetration, within its last digit.
    const double load = (11950.0 + 2.0 * (1185.0 + 22.4 + 17.6)) * 9.80665 / 4.0;
    CHECK(std::sqrt(load / 5.649e7) == Approx(0.6 - 0.575).margin(kPrinted));
  }
}

TEST_CASE("The truck's suspension stands upright and the driver above the front axle") {
  const TruckAtStart truck;
  CHECK(
      (truck.at("chassis.front_spring") - truck.at("front_axle.origin") - Eigen::Vector2d(0.0, 0.4)).norm() <
      kClosed);
  CHECK((truck.at("chassis.rear_spring") - truck.at("rear_axle.origin") - Eigen::Vector2d(0.0, 0.4)).norm() <
        kClosed);
  CHECK((truck.at("chassis.seat") - truck.at("chassis.front_spring") - Eigen::Vector2d(0.0, 0.9)).norm() <
        kClosed);
  CHECK(dynamics::find_leading_position(truck.model, truck.vehicle, truck.terms.markers()) == -1.5);
}

TEST_CASE("The bump run is the paper's") {
  const TruckAtStart truck;
  CHECK(truck.run.speed == 3.0);
  CHECK(truck.run.duration == 5.0);
  CHECK(truck.run.output_step == 1e-3);
  CHECK(truck.run.start == dynamics::Run::Start::kEquilibrium);
  CHECK(dynamics::resolve_modes(truck.run, truck.vehicle).at("chassis") == std::vector<int>{1, 2});
  CHECK(truck.road->height(1.2) == Approx(0.2).epsilon(1e-12));  // half-sine from 1.0 to 1.4 m
  CHECK(truck.road->height(0.999) == 0.0);
  CHECK(truck.road->height(1.401) == 0.0);
  CHECK(dynamics::resolve_output_points(truck.run, truck.vehicle).size() == 4);
}
