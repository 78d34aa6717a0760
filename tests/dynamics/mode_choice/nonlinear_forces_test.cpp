// Forces beyond linear laws under a known motion, on a mass between a spring and a damper.
#include "dynamics/mode_choice/nonlinear_forces.h"

#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "dynamics/forces/spring_damper.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::LinearVehicle;
using dynamics::PiecewisePolynomial;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

constexpr double kMass = 50.0, kStiffness = 4e4, kCompression = 300.0, kRebound = 900.0, kLength = 1.0;
constexpr double kOmega = 2.0 * pi * 2.0;
constexpr Eigen::Index kLines = 500;

// A body that slides upright on a spring-damper of free length 1 m, without weight.
dynamics::Model make_sprung_mass(const PiecewisePolynomial& spring, const PiecewisePolynomial& damper) {
  dynamics::Model model;
  model.gravity.setZero();
  const int body = test::add_body(model, dynamics::make_rigid_body("body", kMass, 3.0));
  const int ground = test::add_marker(model, dynamics::kGround, {0.0, 0.0});
  model.forces.push_back(std::make_unique<dynamics::SpringDamper>(
      "strut", dynamics::SpringDamper::Parameters{.marker_a = ground,
                                                  .marker_b = test::add_marker(model, body, {0.0, 0.0}),
                                                  .free_length = kLength,
                                                  .spring = spring,
                                                  .damper = damper}));
  dynamics::number_model(model);
  return model;
}

// The forces beyond linear laws where the body moves by `amplitude` (cos ωt − 1), from rest, on the body
// along y.
dynamics::NonlinearForces calc_forces(const dynamics::Model& model, double amplitude) {
  const LinearVehicle vehicle(model, Eigen::Vector3d(0.0, kLength, 0.0));
  const auto& system = vehicle.system();
  Eigen::Index place = 0;
  while (vehicle.system().partition.independent[static_cast<std::size_t>(place)] != 1) ++place;
  VectorXd x = VectorXd::Zero(system.mass.rows());
  x[place] = 0.5 * amplitude;  // of e^{iωt}
  const Eigen::MatrixXcd forces =
      (-kOmega * kOmega * system.mass * x + system.stiffness * x).cast<std::complex<double>>() +
      std::complex<double>(0.0, kOmega) * (system.damping * x).cast<std::complex<double>>();
  dynamics::NonlinearForces found =
      calc_nonlinear_forces(vehicle, VectorXd::Constant(1, kOmega), forces, kLines);
  if (!found.elements.empty()) found.forces = found.forces.row(place).eval();
  return found;
}

}  // namespace

TEST_CASE("A damper with two rates has the even harmonics of its rate's size beyond the mean slope") {
  const auto damper = PiecewisePolynomial::from_pieces({0.0}, {{0.0, kRebound}, {0.0, kCompression}});
  const dynamics::Model model = make_sprung_mass(PiecewisePolynomial({0.0, kStiffness}), damper);
  constexpr double kAmplitude = 0.02;
  const dynamics::NonlinearForces found = calc_forces(model, kAmplitude);
  REQUIRE(found.elements == std::vector<std::string>{"strut"});
  CHECK(found.omega[3] == Approx(4.0 * kOmega));
  // F = k̄ ḋ + ½ (k_c − k_r) |ḋ| pushes the body up; |sin| = 2/π − 4/π Σ cos 2kωt / (4k² − 1).
  const double rate = kOmega * kAmplitude, half = 0.5 * (kCompression - kRebound) * rate;
  for (const Eigen::Index k : {1, 2, 5}) {
    const double expected = -half * 2.0 / (pi * static_cast<double>(4 * k * k - 1));
    CHECK(found.forces(0, 2 * k - 1).real() == Approx(expected).epsilon(2e-3));
    CHECK(std::abs(found.forces(0, 2 * k)) < 1e-6 * std::abs(half));
  }
}

TEST_CASE("A stop has forces beyond the linear law where the motion reaches it, and linear laws have none") {
  const PiecewisePolynomial damper({0.0, 600.0});
  PiecewisePolynomial spring({0.0, kStiffness});
  CHECK(calc_forces(make_sprung_mass(spring, damper), 0.05).elements.empty());
  constexpr double kReach = 0.03, kRate = 3e5;
  spring.continue_straight(kReach, kRate, false);
  const dynamics::Model model = make_sprung_mass(spring, damper);
  CHECK(calc_forces(model, 0.49 * kReach).elements.empty());
  // The deflection is −y. Beyond the stop the force is larger by (rate − k)(d − reach): its part of e^{iωt}
  // by a sum over a period.
  constexpr double kAmplitude = 0.025;
  constexpr int kSamples = 20000;
  double expected = 0.0;
  for (int j = 0; j < kSamples; ++j) {
    const double angle = 2.0 * pi * (j + 0.5) / kSamples, d = kAmplitude * (1.0 - std::cos(angle));
    expected += (kRate - kStiffness) * std::max(0.0, d - kReach) * std::cos(angle) / kSamples;
  }
  CHECK(calc_forces(model, kAmplitude).forces(0, 0).real() == Approx(expected).epsilon(2e-3));
}
