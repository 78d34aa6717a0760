#include "dynamics/response/linear_vehicle.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "dynamics/forces/point_contact_tyre.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/response/linear_outputs.h"
#include "dynamics/response/random_response.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;
using dynamics::LinearOutputs;
using dynamics::LinearVehicle;
using dynamics::Model;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

const dynamics::FlatRoad kLevel;
constexpr double kGravity = 9.81;

void add_tyre(Model& model, const std::string& name, int marker, const dynamics::PiecewisePolynomial& spring,
              double damping) {
  model.forces.push_back(std::make_unique<dynamics::PointContactTyre>(
      name,
      dynamics::PointContactTyre::Parameters{
          .marker = marker, .radius = 0.5, .spring = spring, .damping = damping, .one_sided = true},
      dynamics::PlacedRoad{&kLevel, 1.0, 0.0}));
}

// A block on one wheel under its centre.
constexpr double kMass = 80.0, kStiffness = 30000.0, kDamping = 250.0;
Model make_block(double damping) {
  Model model;
  model.gravity = {0.0, -kGravity};
  const int block = test::add_body(model, dynamics::make_rigid_body("block", kMass, 4.0));
  add_tyre(model, "tyre", test::add_marker(model, block, {0.0, 0.0}),
           dynamics::PiecewisePolynomial({0.0, kStiffness}), damping);
  dynamics::number_model(model);
  return model;
}
const Eigen::Vector3d kBlockAtRest(0.0, 0.5 - kMass * kGravity / kStiffness, 0.0);

// A crooked flexible frame pinned to an arm, on two wheels: the wheel of the frame's tip is ahead.
struct FrameOnWheels {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 5);
  Model model;
  VectorXd q;
  int tip = 0;

  FrameOnWheels() {
    model.gravity = {0.0, -kGravity};
    const reduce::Superelement& superelement = frame.superelement;
    const int body = test::add_body(model, dynamics::make_flexible_body("frame", superelement, {1, 2, 4, 5}));
    const int arm = test::add_body(model, dynamics::make_rigid_body("arm", 30.0, 3.0));
    tip = test::add_node_marker(model, body, superelement, node("tip"), {0.1, 0.2});
    const int foot = test::add_node_marker(model, body, superelement, node("foot"));
    // The arm stands under the frame's foot, its wheel at its lower end, held there by a strut.
    test::add_pin(model, "hinge", test::add_marker(model, arm, {0.2, 0.45}), foot);
    const int lower = test::add_marker(model, arm, {-0.2, -0.45}, "lower");
    test::add_spring(model, "strut", lower, test::add_marker(model, body, {0.0, 0.0}), 1.0, 4e4, 600.0);
    add_tyre(model, "ahead", tip, dynamics::PiecewisePolynomial({0.0, 6e4, 1e6}), 900.0);
    add_tyre(model, "behind", lower, dynamics::PiecewisePolynomial({0.0, 6e4, 1e6}), 700.0);
    test::add_marker(model, arm, {0.0, 0.0}, "middle");
    dynamics::number_model(model);
    q = VectorXd::Zero(model.num_coordinates);
    q.head<3>() << 0.0, 0.55, 0.0;
    q.tail<3>() << -0.8, 0.9, 0.0;
  }
  int node(const std::string& name) const { return reduce::find_point(frame.superelement, name); }
};

int row_of(const LinearOutputs& outputs, const std::string& name) {
  const auto found = std::find(outputs.names.begin(), outputs.names.end(), name);
  REQUIRE(found != outputs.names.end());
  return static_cast<int>(found - outputs.names.begin());
}

}  // namespace

TEST_CASE("A block on a wheel answers the road like an oscillator", "[analysis]") {
  const Model model = make_block(kDamping);
  const LinearVehicle vehicle(model, kBlockAtRest);
  REQUIRE(vehicle.inputs().size() == 1);
  CHECK(vehicle.inputs()[0].is_pressed);
  CHECK(vehicle.kinks().empty());
  LinearOutputs outputs = dynamics::make_point_outputs(vehicle, 0);
  outputs.append(dynamics::make_force_outputs(vehicle));
  for (const double frequency : {0.01, 3.0, 40.0}) {
    const dynamics::RoadWave wave = dynamics::make_road_wave(frequency, 5.0);
    CHECK(wave.wavenumber == Approx(2.0 * pi * frequency / 5.0));
    const std::complex<double> s(0.0, wave.frequency);
    const std::complex<double> tyre = kStiffness + kDamping * s, y = tyre / (kMass * s * s + tyre);
    const VectorXcd found = dynamics::calc_response(vehicle, outputs, wave);
    CHECK(std::abs(found[row_of(outputs, "points/block.point/displacement.y")] - y) < 1e-8 * std::abs(y));
    CHECK(std::abs(found[row_of(outputs, "points/block.point/acceleration.y")] - s * s * y) <
          1e-8 * std::abs(s * s * y));
    CHECK(std::abs(found[row_of(outputs, "forces/tyre/force")] - kMass * s * s * y) < 1e-7 * std::abs(tyre));
    CHECK(std::abs(found[row_of(outputs, "forces/tyre/penetration")] - (1.0 - y)) < 1e-8);
  }
}

TEST_CASE("Root mean square on a road of white slope, in closed form", "[analysis]") {
  // δ̈ + 2ζω δ̇ + ω² δ = z̈ with ż of the density S = (2π n₀)² G V: σ² = S/(8ζω).
  const Model model = make_block(kDamping);
  const LinearVehicle vehicle(model, kBlockAtRest);
  const LinearOutputs outputs = dynamics::make_force_outputs(vehicle);
  constexpr double kDensity = 64e-6, kSpeed = 12.0;
  const double slope = std::pow(2.0 * pi * 0.1, 2) * kDensity * kSpeed;
  const double expected = std::sqrt(slope / (4.0 * kDamping / kMass));  // 8ζω = 4 c/m
  const auto road = dynamics::RoadSpectrum::power_law(kDensity, 2.0);
  const VectorXd rms =
      dynamics::calc_root_mean_squares(vehicle, outputs, road, kSpeed, {.from = 1e-4, .to = 1e7});
  CHECK(rms[row_of(outputs, "forces/tyre/penetration")] == Approx(expected).epsilon(1e-6));
  CHECK(dynamics::calc_road_rms(road, kSpeed, {.from = 0.5, .to = 20.0}) ==
        Approx(std::sqrt(kDensity * 0.01 * kSpeed * (1.0 / 0.5 - 1.0 / 20.0))).epsilon(1e-7));
}

TEST_CASE("Without damping there is no mean square, and a range must be one", "[analysis]") {
  const Model model = make_block(0.0);
  const LinearVehicle vehicle(model, kBlockAtRest);
  const LinearOutputs outputs = dynamics::make_force_outputs(vehicle);
  const auto road = dynamics::RoadSpectrum::power_law(64e-6, 2.0);
  const auto integrate = [&](double from, double to) {
    return dynamics::calc_root_mean_squares(vehicle, outputs, road, 12.0, {.from = from, .to = to});
  };
  CHECK_THROWS_WITH(integrate(0.1, 50.0), Contains("does not converge near 3.08"));  // √(k/m)/2π = 3.082 Hz
  CHECK(integrate(4.0, 50.0).allFinite());
  CHECK_THROWS_AS(integrate(2.0, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(dynamics::make_road_wave(0.0, 1.0), std::invalid_argument);
}

TEST_CASE("A flexible frame on two wheels", "[analysis]") {
  FrameOnWheels frame;
  const dynamics::Equilibrium equilibrium = dynamics::find_equilibrium(frame.model, frame.q);
  REQUIRE(equilibrium.stable);
  const LinearVehicle vehicle(frame.model, equilibrium.q);
  REQUIRE(vehicle.inputs().size() == 2);
  REQUIRE((vehicle.inputs()[0].is_pressed && vehicle.inputs()[1].is_pressed));
  const double ahead = vehicle.inputs()[0].distance - vehicle.inputs()[1].distance;
  const dynamics::RoadWave wave = dynamics::make_road_wave(7.0, 9.0);

  SECTION("the later wheel meets the wave later") {
    const VectorXcd delays = vehicle.calc_delays(wave);
    const int first = ahead > 0.0 ? 0 : 1;
    CHECK(std::abs(delays[first] - 1.0) < 1e-15);
    CHECK(std::abs(delays[1 - first] - std::polar(1.0, -wave.frequency * std::abs(ahead) / 9.0)) < 1e-12);
  }

  SECTION("joint and spring move the arm: the outputs satisfy Newton's law") {
    LinearOutputs outputs = dynamics::make_reaction_outputs(vehicle);
    outputs.append(dynamics::make_force_outputs(vehicle));
    outputs.append(dynamics::make_point_outputs(vehicle, frame.model.find_marker("arm.middle")));
    const MatrixXcd y = dynamics::calc_transfer(vehicle, outputs, wave);
    const MatrixXcd q =
        vehicle.system().directions * vehicle.calc_motion(wave.frequency, vehicle.calc_road_action(wave));
    // The strut's force rotates with the strut, so its change along x contains F₀: along the strut's
    // direction u the change is that of F alone, and across it F₀ times the rotation.
    const auto markers = vehicle.equations().terms().markers();
    const auto& strut = dynamic_cast<const dynamics::SpringDamper&>(*frame.model.forces[0]);
    const auto a = static_cast<std::size_t>(strut.markers()[0]),
               b = static_cast<std::size_t>(strut.markers()[1]);
    const Eigen::Vector2d span = markers[b].r - markers[a].r, u = span.normalized();
    const double standing = 4e4 * (1.0 - span.norm());
    const MatrixXcd moved =
        (dynamics::calc_marker_jacobian(vehicle.equations().terms(), static_cast<int>(b)) -
         dynamics::calc_marker_jacobian(vehicle.equations().terms(), static_cast<int>(a)))
            .topRows(2) *
        q;
    for (Eigen::Index i = 0; i < 2; ++i) {
      const Eigen::Vector2cd turn =
          (moved.col(i) - u * (u.transpose() * moved.col(i))) / span.norm();  // of u
      Eigen::Vector2cd force = y.col(i).segment<2>(row_of(outputs, "joints/hinge/reaction.x"));
      force -= u * y(row_of(outputs, "forces/strut/force"), i) + standing * turn;
      force.y() += y(row_of(outputs, "forces/behind/force"), i);
      const Eigen::Vector2cd inertia = -wave.frequency * wave.frequency * 30.0 *
                                       q.col(i).segment<2>(frame.model.bodies[1].first_coordinate);
      CHECK((force - inertia).norm() < 1e-6 * inertia.norm());
    }
  }
}

TEST_CASE("Kinks at rest are found and named, each by position or by velocity", "[analysis]") {
  const Model smooth = make_block(kDamping);
  CHECK(LinearVehicle(smooth, kBlockAtRest).kinks().empty());
  Model model = make_block(kDamping);
  test::add_spring(model, "plain", test::add_marker(model, dynamics::kGround, {0.0, 2.0}),
                   test::add_marker(model, 0, {0.0, 0.3}), 1.2, 0.0, 10.0);
  const int above = test::add_marker(model, dynamics::kGround, {0.0, 3.0});
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>(
      "stop",
      dynamics::SpringDamper::Parameters{.marker_a = above,
                                         .marker_b = 0,
                                         .free_length = 3.0 - kBlockAtRest.y(),  // touches just here
                                         .spring = dynamics::PiecewisePolynomial::through_points(
                                             std::vector{-1.0, 0.0, 1.0}, std::vector{0.0, 0.0, 500.0}),
                                         .damper = dynamics::PiecewisePolynomial::through_points(
                                             std::vector{-1.0, 0.0, 1.0}, std::vector{-30.0, 0.0, 10.0})}));
  dynamics::number_model(model);
  const std::vector<dynamics::Kink> kinks = LinearVehicle(model, kBlockAtRest).kinks();
  REQUIRE(kinks.size() == 2);
  CHECK(kinks[0].element == "stop");
  CHECK(kinks[0].in_position);
  CHECK(kinks[1].element == "stop");
  CHECK_FALSE(kinks[1].in_position);
}
