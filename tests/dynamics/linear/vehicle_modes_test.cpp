#include "dynamics/linear/vehicle_modes.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::Model;
using dynamics::VehicleMode;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

// An arm of 1 m pinned at the origin, lying along x, held at its end by an upright spring: I φ̈ + c φ̇ + k φ =
// 0 with I = 1/3 m L² about the pivot; no gravity.
constexpr double kMass = 6.0, kStiffness = 800.0;

Model make_arm(const dynamics::PiecewisePolynomial& damper) {
  Model model;
  const int arm = test::add_body(model, dynamics::make_rigid_body("arm", kMass, kMass / 12.0));
  test::add_pin(model, "pivot", test::add_marker(model, arm, {-0.5, 0.0}),
                test::add_marker(model, dynamics::kGround, {0.0, 0.0}));
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>(
      "spring", dynamics::SpringDamper::Parameters{
                    .marker_a = test::add_marker(model, dynamics::kGround, {1.0, -0.7}),
                    .marker_b = test::add_marker(model, arm, {0.5, 0.0}),
                    .free_length = 0.7,
                    .spring = dynamics::PiecewisePolynomial(std::vector<double>{0.0, kStiffness}),
                    .damper = damper}));
  dynamics::number_model(model);
  return model;
}

std::vector<VehicleMode> modes_of(const Model& model, const VectorXd& q) {
  return dynamics::calc_vehicle_modes(model, dynamics::find_equilibrium(model, q));
}

const double kOmega = std::sqrt(kStiffness / (kMass / 3.0));

std::vector<int> first_modes(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 1);
  return numbers;
}

// (βL)² = ω L² √(m/EI) of the lowest elastic frequency.
double beam_number(const std::vector<VehicleMode>& modes, double length, double EI, double mass_per_length) {
  for (const VehicleMode& mode : modes) {
    if (!mode.is_rigid_body) {
      return 2.0 * pi * mode.undamped_frequency_hz * length * length * std::sqrt(mass_per_length / EI);
    }
  }
  return 0.0;
}

}  // namespace

TEST_CASE("Frequency and damping ratio of a sprung arm", "[analysis]") {
  const double c = 24.0;
  const std::vector<VehicleMode> modes = modes_of(
      make_arm(dynamics::PiecewisePolynomial(std::vector<double>{0.0, c})), Eigen::Vector3d(0.5, 0.0, 0.0));
  REQUIRE(modes.size() == 1);
  const double ratio = c / (2.0 * std::sqrt(kStiffness * kMass / 3.0));
  CHECK(modes[0].undamped_frequency_hz == Approx(kOmega / (2.0 * pi)).epsilon(1e-9));
  CHECK(modes[0].damping_ratio == Approx(ratio).epsilon(1e-8));
  CHECK(modes[0].damped_frequency_hz ==
        Approx(kOmega * std::sqrt(1.0 - ratio * ratio) / (2.0 * pi)).epsilon(1e-8));
  CHECK_FALSE(modes[0].is_rigid_body);
  REQUIRE(modes[0].participants.size() == 1);
  CHECK(modes[0].participants[0].share == 1.0);
  CHECK(modes[0].participants[0].main_mode == 0);
}

TEST_CASE("A damper of two slopes counts with their mean", "[analysis]") {
  const dynamics::PiecewisePolynomial two_slopes =
      dynamics::PiecewisePolynomial::through_points(std::array{-1.0, 0.0, 1.0}, std::array{-30.0, 0.0, 10.0});
  const std::vector<VehicleMode> modes = modes_of(make_arm(two_slopes), Eigen::Vector3d(0.5, 0.0, 0.0));
  CHECK(modes[0].damping_ratio == Approx(20.0 / (2.0 * std::sqrt(kStiffness * kMass / 3.0))).epsilon(1e-8));
}

TEST_CASE("An overdamped mode keeps its undamped frequency and does not oscillate", "[analysis]") {
  const double c = 5.0 * 2.0 * std::sqrt(kStiffness * kMass / 3.0);
  const std::vector<VehicleMode> modes = modes_of(
      make_arm(dynamics::PiecewisePolynomial(std::vector<double>{0.0, c})), Eigen::Vector3d(0.5, 0.0, 0.0));
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].undamped_frequency_hz == Approx(kOmega / (2.0 * pi)).epsilon(1e-9));
  CHECK(modes[0].damped_frequency_hz == 0.0);
  CHECK(modes[0].damping_ratio == Approx(5.0).epsilon(1e-8));
  REQUIRE(modes[0].decay_rate);
  CHECK(*modes[0].decay_rate == Approx(kOmega * (5.0 + std::sqrt(24.0))).epsilon(1e-8));
}

TEST_CASE("A hanging pendulum swings with the frequency of the equivalent length", "[analysis]") {
  const std::vector<VehicleMode> modes =
      modes_of(test::make_pendulum(3.0, 0.6, 1.3, 9.81), test::place_pendulum(0.6, -1.0));
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].undamped_frequency_hz == Approx(std::sqrt(9.81 / 1.3) / (2.0 * pi)).epsilon(1e-9));
  CHECK(modes[0].damping_ratio == Approx(0.0).margin(1e-9));
}

TEST_CASE("A double pendulum of equal bobs", "[analysis]") {
  // ω² = (2 ± √2) g/l for two points of equal mass on massless rods of l; bars swinging like points are not
  // not such points; hence two point-like bodies (inertia 1e-9 kg·m²) on their rods.
  Model model;
  model.gravity = {0.0, -9.81};
  for (const char* name : {"upper", "lower"})
    test::add_body(model, dynamics::make_rigid_body(name, 2.0, 1e-9));
  test::add_pin(model, "top", test::add_marker(model, 0, {0.0, 0.8}),
                test::add_marker(model, dynamics::kGround, {0.0, 0.0}));
  test::add_pin(model, "knee", test::add_marker(model, 1, {0.0, 0.8}),
                test::add_marker(model, 0, {0.0, 0.0}));
  dynamics::number_model(model);
  VectorXd q(6);
  q << 0.0, -0.8, 0.0, 0.0, -1.6, 0.0;
  const std::vector<VehicleMode> modes = modes_of(model, q);
  REQUIRE(modes.size() == 2);
  CHECK(modes[0].undamped_frequency_hz ==
        Approx(std::sqrt((2.0 - std::sqrt(2.0)) * 9.81 / 0.8) / (2.0 * pi)).epsilon(1e-7));
  CHECK(modes[1].undamped_frequency_hz ==
        Approx(std::sqrt((2.0 + std::sqrt(2.0)) * 9.81 / 0.8) / (2.0 * pi)).epsilon(1e-7));
}

// Beams with the modes of their reduction: (βL)² of [Blevins 1979], table 8-1, approached from above as modes
// are added (Rayleigh–Ritz), and reached with all of a fine model.
constexpr double kEI = 3e4, kEA = 5e8, kMassPerLength = 8.0, kLength = 3.0;

TEST_CASE(
    "An unattached beam has three rigid-body modes, and free–free frequencies from modes clamped at its "
    "middle",
    "[analysis]") {
  std::vector<double> x;
  for (int i = -10; i <= 10; ++i) x.push_back(0.05 * kLength * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, kEA, kEI, kMassPerLength), 60);
  double last = 1e9;
  for (const int num_modes : {2, 4, 8, 16, 60}) {
    Model model;
    test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, first_modes(num_modes)));
    test::add_marker(model, 0, {0.5 * kLength, 0.0});
    dynamics::number_model(model);
    VectorXd q = VectorXd::Zero(model.num_coordinates);
    q.head<3>() << 2.0, -1.0, 0.8;
    const std::vector<VehicleMode> modes = modes_of(model, q);
    REQUIRE(modes.size() == static_cast<std::size_t>(3 + num_modes));
    for (std::size_t k = 0; k < modes.size(); ++k) {
      CHECK(modes[k].is_rigid_body == (k < 3));
      if (k < 3) CHECK(modes[k].undamped_frequency_hz == 0.0);
    }
    const double found = beam_number(modes, kLength, kEI, kMassPerLength);
    INFO(num_modes << " modes");
    CHECK(found < last);
    CHECK(found > 22.3732);
    if (num_modes == 60) CHECK(found == Approx(22.37329).epsilon(2e-5));
    last = found;
  }
}

TEST_CASE("A pinned beam from the modes of a cantilever", "[analysis]") {
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(0.05 * kLength * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, kEA, kEI, kMassPerLength), 60);
  double last = 1e9;
  for (const int num_modes : {1, 2, 4, 8, 60}) {
    Model model;
    test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, first_modes(num_modes)));
    test::add_pin(model, "pin", test::add_marker(model, 0, {0.0, 0.0}),
                  test::add_marker(model, dynamics::kGround, {1.0, 2.0}));
    test::add_marker(model, 0, {kLength, 0.0});
    dynamics::number_model(model);
    VectorXd q = VectorXd::Zero(model.num_coordinates);
    q.head<3>() << 1.0, 2.0, 0.8;
    const std::vector<VehicleMode> modes = modes_of(model, q);
    REQUIRE(modes.size() == static_cast<std::size_t>(1 + num_modes));
    CHECK(modes[0].is_rigid_body);  // it turns about its pin
    const double found = beam_number(modes, kLength, kEI, kMassPerLength);
    INFO(num_modes << " modes");
    CHECK(found < last);
    CHECK(found > 15.4182);
    if (num_modes == 60) CHECK(found == Approx(15.41821).epsilon(2e-5));
    last = found;
  }
}

TEST_CASE("The frequencies of the vehicle do not depend on where its body is held, with all modes kept",
          "[analysis]") {
  // The same beam on two springs, its frame at an end or in the middle.
  std::vector<double> lowest;
  for (const int reference : {0, 4, 6}) {
    std::vector<double> x;
    for (int i = 0; i <= 8; ++i) x.push_back(0.125 * kLength * (i - reference));
    const test::BeamSuperelement beam =
        test::make_beam_superelement(test::make_straight_beam("beam", x, kEA, kEI, kMassPerLength), 24);
    Model model;
    const int body =
        test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, first_modes(24)));
    for (const int node : {1, 7}) {
      const Eigen::Vector2d at = beam.superelement.node_positions.col(node);
      for (const Eigen::Vector2d& away : {Eigen::Vector2d(0.0, -0.5), Eigen::Vector2d(-0.5, 0.0)}) {
        test::add_spring(model, "spring", test::add_node_marker(model, body, beam.superelement, node),
                         test::add_marker(model, dynamics::kGround, at + away), 0.5, 7e4, 0.0);
      }
    }
    dynamics::number_model(model);
    std::vector<double> frequencies;
    for (const VehicleMode& mode : modes_of(model, VectorXd::Zero(model.num_coordinates))) {
      CHECK_FALSE(mode.is_rigid_body);
      frequencies.push_back(mode.undamped_frequency_hz);
    }
    if (lowest.empty()) lowest.assign(frequencies.begin(), frequencies.begin() + 8);
    for (std::size_t k = 0; k < 8; ++k) CHECK(frequencies[k] == Approx(lowest[k]).epsilon(1e-7));
  }
}

TEST_CASE("Bounce and pitch on soft springs are no rigid-body modes beside the fast ones of a stiff beam",
          "[analysis]") {
  // A stiff beam with all its modes, held by soft springs along and across it at both quarters: it moves as
  // if rigid. ω² = 2k/m along and across, 2k a²/J about its middle, a the springs' distance from it; its
  // first bending is 150 times faster, so that it gives way by less than 1e-4.
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(0.05 * kLength * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, kEA, kEI, kMassPerLength), 60);
  Model model;
  const int body =
      test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, first_modes(60)));
  const double k = 12.0;  // N/m
  for (const int node : {5, 15}) {
    const Eigen::Vector2d at = beam.superelement.node_positions.col(node);
    for (const Eigen::Vector2d& away : {Eigen::Vector2d(0.0, -0.5), Eigen::Vector2d(-0.5, 0.0)}) {
      test::add_spring(model, "spring", test::add_node_marker(model, body, beam.superelement, node),
                       test::add_marker(model, dynamics::kGround, at + away), 0.5, k, 0.0);
    }
  }
  dynamics::number_model(model);
  const std::vector<VehicleMode> modes = modes_of(model, VectorXd::Zero(model.num_coordinates));
  const double mass = kMassPerLength * kLength, inertia = mass * kLength * kLength / 12.0, a = 0.25 * kLength;
  for (int i = 0; i < 3; ++i) CHECK_FALSE(modes[static_cast<std::size_t>(i)].is_rigid_body);
  CHECK(modes.back().undamped_frequency_hz > 1e5 * modes[0].undamped_frequency_hz);
  const double plain = std::sqrt(2.0 * k / mass) / (2.0 * pi),
               pitch = std::sqrt(2.0 * k * a * a / inertia) / (2.0 * pi);
  CHECK(modes[0].undamped_frequency_hz == Approx(pitch).epsilon(1e-4));
  CHECK(modes[1].undamped_frequency_hz == Approx(plain).epsilon(1e-4));
  CHECK(modes[2].undamped_frequency_hz == Approx(plain).epsilon(1e-4));
}

TEST_CASE("Without damping the damped frequencies are the undamped ones", "[analysis]") {
  std::vector<double> x;
  for (int i = 0; i <= 20; ++i) x.push_back(0.05 * kLength * i);
  const test::BeamSuperelement beam =
      test::make_beam_superelement(test::make_straight_beam("beam", x, kEA, kEI, kMassPerLength), 60);
  Model model;
  test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, first_modes(60)));
  model.bodies[0].damping.setZero();
  for (const int node : {0, 20}) {  // pinned at both ends: two modes follow from the others
    const Eigen::Vector2d at = beam.superelement.node_positions.col(node);
    test::add_pin(model, "pin", test::add_node_marker(model, 0, beam.superelement, node),
                  test::add_marker(model, dynamics::kGround, at));
  }
  dynamics::number_model(model);
  for (const VehicleMode& mode : modes_of(model, VectorXd::Zero(model.num_coordinates))) {
    INFO(mode.undamped_frequency_hz);
    CHECK_FALSE(mode.is_rigid_body);
    CHECK(mode.damped_frequency_hz == Approx(mode.undamped_frequency_hz).epsilon(1e-8));
    CHECK(std::abs(mode.damping_ratio) < 1e-8);
  }
}
