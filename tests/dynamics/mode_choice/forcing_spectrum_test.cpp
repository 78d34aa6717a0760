// The Fourier series of a known forcing, and the time until a road ceases to act.
#include "dynamics/mode_choice/forcing_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "dynamics/forces/applied_force.h"
#include "dynamics/road/bump_road.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/small_models.h"
#include "tests/dynamics/truck.h"

using namespace sprung;
using dynamics::BumpRoad;
using dynamics::BumpShape;
using dynamics::LinearVehicle;
using dynamics::TimeFunction;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

// With a torque on the pendulum's body.
dynamics::Model make_driven_pendulum(const TimeFunction& torque) {
  dynamics::Model model = test::make_pendulum(1.0, 0.5, 0.7, 9.81);
  const int marker = test::add_marker(model, 0, {0.0, 0.0});
  model.forces.push_back(std::make_unique<dynamics::AppliedForce>(
      "drive",
      dynamics::AppliedForce::Parameters{
          .marker = marker, .force_x = TimeFunction(0.0), .force_y = TimeFunction(0.0), .torque = torque}));
  dynamics::number_model(model);
  return model;
}

}  // namespace

TEST_CASE("The forcing lasts until the last wheel has left the road's last feature", "[choice][truck]") {
  const test::TruckAtRest truck(0);
  const LinearVehicle vehicle(truck.model, truck.equilibrium.q);
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

TEST_CASE("The forcing's lines are the closed transform of a bump, and their sum is the road", "[choice]") {
  const dynamics::Model pendulum = test::make_pendulum(1.0, 0.5, 0.7, 9.81);
  const LinearVehicle vehicle(pendulum, test::place_pendulum(0.5, -0.5 * pi));
  const BumpRoad road({.shape = BumpShape::kHalfSine, .start = 1.0, .length = 0.4, .height = 0.2});
  const dynamics::ForcingSpectrum forcing =
      dynamics::calc_forcing_spectrum(vehicle, {.road = &road, .speed = 4.0, .duration = 1.0}, 0.5, 60.0);
  CHECK(forcing.period == 1.5);
  // ∫ sin(πt/τ) e^{−iωt} dt over its half wave, τ = 0.1 s, from t = 0.25 s on. The sum over samples differs
  // by the kinks' lines beyond the highest frequency sampled: (60/480)² of their own.
  const double tau = 0.1;
  for (const Eigen::Index line : {0, 6, 40}) {
    const double omega = 2.0 * pi * forcing.frequency(line);
    const std::complex<double> i(0.0, 1.0);
    const std::complex<double> closed = 0.2 * std::exp(-i * omega * 0.25) * (pi / tau) *
                                        (1.0 + std::exp(-i * omega * tau)) /
                                        (std::pow(pi / tau, 2) - omega * omega);
    CHECK(std::abs(forcing.period * forcing.road[line] - closed) < 1e-4 * 0.2 * tau);
  }
  const Eigen::Index n = 512;
  const VectorXd history = dynamics::calc_history(forcing.road.transpose(), n);
  double worst = 0.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    worst = std::max(worst, std::abs(history[j] - road.height(4.0 * 1.5 * static_cast<double>(j) / n)));
  }
  CHECK(worst < 0.02 * 0.2);  // what is above 60 Hz: the kinks are rounded
}

TEST_CASE("A jump of a force keeps its place among the samples", "[choice]") {
  // 3 N·m from 0.2337 s to 0.6071 s: (3/iω) (e^{−iω 0.2337} − e^{−iω 0.6071}). The mean over a sample reduces
  // a line by (ω dt)²/24, here by 0.3 % at most; a jump moved to the next sample would be up to 10 % off.
  const dynamics::Model pendulum = make_driven_pendulum(
      TimeFunction::lines(std::array{0.2337, 0.2337, 0.6071, 0.6071}, std::array{0.0, 3.0, 3.0, 0.0}));
  const LinearVehicle vehicle(pendulum, test::place_pendulum(0.5, -0.5 * pi));
  const dynamics::ForcingSpectrum forcing =
      dynamics::calc_forcing_spectrum(vehicle, {.road = nullptr, .speed = 0.0, .duration = 1.0}, 0.5, 20.0);
  REQUIRE(forcing.applied.rows() == 1);
  for (const Eigen::Index line : {0, 7, 28}) {
    const std::complex<double> s(0.0, 2.0 * pi * forcing.frequency(line));
    const std::complex<double> closed = 3.0 / s * (std::exp(-s * 0.2337) - std::exp(-s * 0.6071));
    CAPTURE(line);
    CHECK(std::abs(forcing.period * forcing.applied(0, line) - closed) < 6e-3 * 6.0 / std::abs(s));
  }
}

TEST_CASE("A jump within half a sample of the period's end changes no sample", "[choice]") {
  // 5 N·m for the last 1e-7 s: without time to settle, the nearest sample is that of the next period's start.
  const dynamics::Model pendulum =
      make_driven_pendulum(TimeFunction::lines(std::array{1.0 - 1e-7, 1.0 - 1e-7}, std::array{0.0, 5.0}));
  const LinearVehicle vehicle(pendulum, test::place_pendulum(0.5, -0.5 * pi));
  const dynamics::ForcingSpectrum forcing =
      dynamics::calc_forcing_spectrum(vehicle, {.road = nullptr, .speed = 0.0, .duration = 1.0}, 0.0, 20.0);
  CHECK(forcing.applied.size() == 0);
}

TEST_CASE("A force that oscillates beyond the highest line does not seem to be a slow one", "[choice]") {
  // 256 samples in 1.5 s would show 175 Hz as 4.3 Hz with its full amplitude. Its own lines below 10 Hz come
  // from its end alone and are of the order of 1/(ω T).
  const dynamics::Model pendulum =
      make_driven_pendulum(TimeFunction::harmonic({.amplitude = 5.0, .frequency_hz = 175.0}));
  const LinearVehicle vehicle(pendulum, test::place_pendulum(0.5, -0.5 * pi));
  const dynamics::ForcingSpectrum forcing =
      dynamics::calc_forcing_spectrum(vehicle, {.road = nullptr, .speed = 0.0, .duration = 1.0}, 0.5, 10.0);
  REQUIRE(forcing.applied.rows() == 1);
  CHECK(forcing.applied.cwiseAbs().maxCoeff() < 3.0 * 5.0 / (2.0 * pi * 175.0 * 1.5));
}

TEST_CASE("A forcing without duration, or too few times of a series, is the caller's mistake", "[choice]") {
  const dynamics::Model pendulum = test::make_pendulum(1.0, 0.5, 0.7, 9.81);
  const LinearVehicle vehicle(pendulum, test::place_pendulum(0.5, -0.5 * pi));
  CHECK_THROWS_WITH(
      dynamics::calc_forcing_spectrum(vehicle, {.road = nullptr, .speed = 1.0, .duration = 0.0}, 1.0, 9.0),
      Contains("needs duration > 0 s"));
  CHECK_THROWS_WITH(dynamics::calc_history(Eigen::RowVectorXcd::Zero(4), 8),
                    Contains("8 times are too few for 4"));
}
