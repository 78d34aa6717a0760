// Generalized-α on the constrained system: against the linear theory of the method, against its order, and
// against the other integrators, with which it shares neither coordinates nor formulas.
#include "dynamics/integration/generalized_alpha/generalized_alpha.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"
#include "dynamics/joints/coordinate_joint.h"
#include "dynamics/linear/assembly.h"
#include "dynamics/simulation/transient.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;
using dynamics::GeneralizedAlpha;
using dynamics::GeneralizedAlphaStepper;
using dynamics::Model;
using dynamics::SteppingMethod;
using dynamics::SteppingOptions;
using Eigen::VectorXd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGravity = 9.81;

// (x, h v, h² q̈, h² a) of ẍ = −ω²x after a step, from those before; Ω = ω h. Source: [Chung & Hulbert 1993]
Eigen::Matrix4d amplification(const GeneralizedAlpha& method, double Omega) {
  Eigen::Matrix4d after, before;
  after << 1.0, 0.0, 0.0, -method.beta,  //
      0.0, 1.0, 0.0, -method.gamma,      //
      Omega * Omega, 0.0, 1.0, 0.0,      //
      0.0, 0.0, method.alpha_f - 1.0, 1.0 - method.alpha_m;
  before << 1.0, 1.0, 0.0, 0.5 - method.beta,  //
      0.0, 1.0, 0.0, 1.0 - method.gamma,       //
      0.0, 0.0, 0.0, 0.0,                      //
      0.0, 0.0, method.alpha_f, -method.alpha_m;
  return after.fullPivLu().solve(before);
}

SteppingOptions fixed_steps(double length, double spectral_radius = 0.8) {
  return {.method = SteppingMethod::kGeneralizedAlpha,
          .relative_tolerance = 1e-10,  // of the iteration
          .generalized_alpha = {.spectral_radius = spectral_radius, .fixed_step = length}};
}

GeneralizedAlphaStepper make_stepper(const Model& model, const SteppingOptions& options) {
  return {model, options.relative_tolerance, options.generalized_alpha};
}

void begin(GeneralizedAlphaStepper& stepper, const dynamics::State& state, double end_time) {
  stepper.start(state);
  stepper.evaluate(state.time, dynamics::SystemStepper::Level::kAccelerations);
  stepper.piece().update_branches(stepper.equations().terms());
  stepper.resume(state.time, end_time);
}

void finish(GeneralizedAlphaStepper& stepper) {
  while (stepper.step(kInfinity) != dynamics::Integrator::StepResult::kEnded) {
  }
}

// A mass of 2 kg on a spring along x, so long that no iterate of Newton's turns it round.
constexpr double kFar = 2e4;  // m
Model make_oscillator(double stiffness) {
  Model model;
  const int mass = test::add_body(model, dynamics::make_rigid_body("mass", 2.0, 1.0));
  test::add_spring(model, "spring", test::add_marker(model, dynamics::kGround, {0.0, 0.0}),
                   test::add_marker(model, mass, {0.0, 0.0}), kFar, stiffness, 0.0);
  dynamics::number_model(model);
  return model;
}

// Crank, coupler and rocker under gravity; the coupler a flexible beam with an inertia of any kind, or rigid.
struct FourBar {
  test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("coupler", {-0.25, -0.1, 0.0, 0.1, 0.25}, 2e6, 40.0, 3.0), 6);
  Model model;
  dynamics::State start;

  // @param deformation  of each mode at the start: the coupler then vibrates [kg^½·m]
  explicit FourBar(const std::vector<int>& modes, double deformation = 0.0) {
    model.gravity = {0.0, -kGravity};
    const int crank = test::add_body(model, dynamics::make_rigid_body("crank", 1.2, 0.01));
    const int coupler =
        test::add_body(model, dynamics::make_flexible_body("coupler", beam.superelement, modes));
    const int rocker = test::add_body(model, dynamics::make_rigid_body("rocker", 0.8, 0.02));
    const auto ground = [&](double x) { return test::add_marker(model, dynamics::kGround, {x, 0.0}); };
    test::add_pin(model, "main", ground(0.0), test::add_marker(model, crank, {-0.1, 0.0}));
    test::add_pin(model, "crank", test::add_marker(model, crank, {0.1, 0.0}),
                  test::add_node_marker(model, coupler, beam.superelement, 0));
    test::add_pin(model, "far", test::add_node_marker(model, coupler, beam.superelement, 4),
                  test::add_marker(model, rocker, {0.2, 0.0}));
    test::add_pin(model, "pivot", ground(0.5), test::add_marker(model, rocker, {-0.2, 0.0}));
    dynamics::number_model(model);
    VectorXd q = VectorXd::Zero(model.num_coordinates);
    const auto place = [&](int body, double x, double y, double angle) {
      q.segment<3>(model.bodies[static_cast<std::size_t>(body)].first_coordinate) << x, y, angle;
    };
    place(crank, 0.06, 0.08, 0.9);
    place(coupler, 0.35, 0.27, 0.4);
    place(rocker, 0.55, 0.18, 1.3);
    q.segment(model.bodies[static_cast<std::size_t>(coupler)].first_coordinate + 3, std::ssize(modes))
        .setConstant(deformation);
    dynamics::assemble_positions(model, q);
    VectorXd v = VectorXd::Zero(q.size());
    v[2] = 9.0;
    dynamics::project_velocities(model, 0.0, q, v);
    start = test::make_state(model, q, v);
  }
};

struct Outputs {
  std::vector<VectorXd> q, v, lambda;
  double lowest_energy = kInfinity, highest_energy = -kInfinity;
  dynamics::TransientStatistics statistics;
};

Outputs run(const Model& model, const dynamics::State& start, double end_time,
            const SteppingOptions& options) {
  Outputs outputs;
  dynamics::TransientOptions transient;
  transient.end_time = end_time;
  transient.output_step = 0.01;
  transient.integrator = options;
  transient.on_output = [&](const dynamics::Snapshot& now) {
    outputs.q.push_back(now.q);
    outputs.v.push_back(now.v);
    outputs.lambda.push_back(now.multipliers());
    const double energy = now.energy.stored.total() + now.energy.dissipated - now.energy.input;
    outputs.lowest_energy = std::min(outputs.lowest_energy, energy);
    outputs.highest_energy = std::max(outputs.highest_energy, energy);
  };
  outputs.statistics = dynamics::run_transient(model, start, transient);
  return outputs;
}

double largest_difference(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace

TEST_CASE("The amplification of a mode of infinite frequency is the spectral radius", "[analysis]") {
  for (const double radius : {0.0, 0.3, 0.8, 1.0}) {
    const GeneralizedAlpha method(radius);
    const Eigen::Vector4cd values = amplification(method, 1e6).eigenvalues();
    // A multiple root: known to the square or cube root of rounding
    CHECK(values.cwiseAbs().maxCoeff() == Approx(radius).margin(1e-3));
    for (const double Omega : {1e-2, 0.1, 1.0, 10.0, 100.0}) {
      CHECK(amplification(method, Omega).eigenvalues().cwiseAbs().maxCoeff() <= 1.0 + 1e-9);
    }
  }
  CHECK_THROWS_WITH(GeneralizedAlpha(1.2), Contains("spectral_radius must be 0 to 1, got 1.2"));
  CHECK_THROWS_AS(GeneralizedAlpha(std::nan("")), std::invalid_argument);
}

TEST_CASE("A step's errors are those that follow from its coefficients", "[analysis]") {
  // x = e^{iωt} in (integration/generalized_alpha, eqs. 1, 2) with what the auxiliary acceleration becomes in
  // the long run.
  using Complex = std::complex<double>;
  for (const double radius : {0.0, 0.5, 0.8, 1.0}) {
    const GeneralizedAlpha method(radius);
    const double x = 1e-3;  // ω h
    const Complex E = std::exp(Complex(0.0, x)), acceleration = -x * x;
    const Complex a = acceleration * ((1.0 - method.alpha_f) * E + method.alpha_f) /
                      ((1.0 - method.alpha_m) * E + method.alpha_m);
    const Complex v = Complex(0.0, x);
    const Complex error_q = 1.0 + v + ((0.5 - method.beta) + method.beta * E) * a - E;
    const Complex error_v = v + ((1.0 - method.gamma) + method.gamma * E) * a - v * E;
    CHECK(std::abs(error_q) / std::pow(x, 3) == Approx(std::abs(method.position_error())).margin(1e-3));
    CHECK(std::abs(error_v) / std::pow(x, 4) == Approx(std::abs(method.velocity_error())).margin(1e-3));
  }
}

TEST_CASE("A stiff oscillator loses its amplitude by the spectral radius in each step", "[analysis]") {
  const double length = 0.1, stiffness = 2e8;  // ω h = 1000
  const Model model = make_oscillator(stiffness);
  const Eigen::Vector3d start(kFar + 1e-3, 0.0, 0.0);
  for (const double radius : {0.0, 0.5, 0.8, 0.95}) {
    INFO("spectral radius " << radius);
    const GeneralizedAlpha method(radius);
    GeneralizedAlphaStepper stepper = make_stepper(model, fixed_steps(length, radius));
    begin(stepper, test::make_state(model, start, VectorXd::Zero(3)), 40.0 * length);
    const auto x_and_v = [&] {
      return Eigen::Vector2d(stepper.motion().q[0] - kFar, length * stepper.motion().v[0]);
    };
    // The first step gives the auxiliary accelerations at its ends. From there the linear theory must hold.
    const Eigen::Vector2d before = x_and_v();
    stepper.step(kInfinity);
    const Eigen::Vector2d after = x_and_v();
    Eigen::Matrix2d shares;
    shares << 0.5 - method.beta, method.beta, 1.0 - method.gamma, method.gamma;
    const Eigen::Vector2d auxiliary =
        shares.inverse() * Eigen::Vector2d(after[0] - before[0] - before[1], after[1] - before[1]);
    const double first = before.norm();
    Eigen::Vector4d expected(after[0], after[1], length * length * stepper.motion().v_dot[0], auxiliary[1]);
    const Eigen::Matrix4d matrix = amplification(method, length * std::sqrt(stiffness / 2.0));
    for (int i = 2; i <= 40; ++i) {
      stepper.step(kInfinity);
      expected = matrix * expected;
      CHECK((x_and_v() - expected.head<2>()).cwiseAbs().maxCoeff() < 1e-6 * first);
    }
    // A root that is threefold at infinity grows by i² beside ρⁱ.
    const double left = std::abs(stepper.motion().q[0] - kFar) / first;
    CHECK(left < 40.0 * 40.0 * std::pow(radius, 40) + 1e-6);
    if (radius >= 0.8) CHECK(left > 0.1 * std::pow(radius, 40));  // smaller ones leave rounding
  }
}

TEST_CASE("Steps that become shorter do not enlarge vibration of modes that they do not resolve",
          "[analysis]") {
  // A free beam whose modes, ω > 140 rad/s, vibrate at the start; each step is half as long as the last one.
  // In the limit of infinite ω, the accelerations become 0.909 times as large in a step, 1.892 times without
  // (integration/generalized_alpha, eq. 8).
  const test::BeamSuperelement beam = test::make_beam_superelement(
      test::make_straight_beam("beam", {-0.25, -0.1, 0.0, 0.1, 0.25}, 2e6, 40.0, 3.0), 6);
  Model model;
  test::add_body(model, dynamics::make_flexible_body("beam", beam.superelement, {1, 2, 3, 4, 5, 6}));
  dynamics::number_model(model);
  VectorXd v = VectorXd::Zero(model.num_coordinates);
  v.tail<6>().setConstant(1e-14);  // so that the first prediction, from ω²v, is no large motion
  double length = 30.0;
  GeneralizedAlphaStepper stepper = make_stepper(model, fixed_steps(length));
  begin(stepper, test::make_state(model, VectorXd::Zero(model.num_coordinates), v), 1e4);
  double last = 0.0, ratio = 0.0;
  for (int i = 0; i < 8; ++i) {
    stepper.step(length);
    length *= 0.5;
    const double largest = stepper.motion().v_dot.tail<6>().cwiseAbs().maxCoeff();
    ratio = largest / last;
    last = largest;
  }
  CHECK(ratio == Approx(0.909).margin(0.002));
}

TEST_CASE("Positions, velocities and multipliers converge with order 2", "[analysis]") {
  const Model pendulum = test::make_pendulum(1.0, 0.9, 1.0, kGravity);
  const FourBar rigid({}), flexible({1, 2, 3}, 5e-3);
  struct Case {
    const Model& model;
    dynamics::State start;
    double end, longest;
  };
  const std::vector<Case> cases{
      {pendulum, test::make_state(pendulum, test::place_pendulum(0.9, 0.3), VectorXd::Zero(3)), 1.0, 0.01},
      {rigid.model, rigid.start, 0.4, 2e-3},
      {flexible.model, flexible.start, 0.1, 2e-5}};
  for (const Case& test_case : cases) {
    const Model& model = test_case.model;
    const Outputs reference = run(model, test_case.start, test_case.end,
                                  {.method = SteppingMethod::kAdams, .relative_tolerance = 1e-12});
    Eigen::Array4d last = Eigen::Array4d::Zero();
    for (int halving = 0; halving < 3; ++halving) {
      GeneralizedAlphaStepper stepper =
          make_stepper(model, fixed_steps(test_case.longest / std::pow(2.0, halving)));
      begin(stepper, test_case.start, test_case.end);
      finish(stepper);
      const dynamics::ConstrainedMotion& end = stepper.motion();
      stepper.evaluate(test_case.end, dynamics::SystemStepper::Level::kAccelerations);
      // As integrated; and the multipliers as they are put out, from closed positions and velocities.
      const Eigen::Array4d error((end.q - reference.q.back()).norm(), (end.v - reference.v.back()).norm(),
                                 (end.lambda - reference.lambda.back()).norm(),
                                 (stepper.equations().multipliers() - reference.lambda.back()).norm());
      if (halving > 0) {
        const Eigen::Array4d order = (last / error).log() / std::numbers::ln2;
        INFO(model.num_coordinates << " coordinates: orders " << order.transpose());
        CHECK(order.minCoeff() > 1.9);
        CHECK(order.maxCoeff() < 2.1);
      }
      last = error;
    }
  }
}

TEST_CASE("Velocities break their constraints to second order, outputs do not", "[analysis]") {
  const FourBar mechanism({});
  const auto violation = [&](double length) {
    const Outputs outputs = run(mechanism.model, mechanism.start, 0.4, fixed_steps(length));
    dynamics::SystemTerms terms(mechanism.model);
    VectorXd rate = VectorXd::Zero(mechanism.model.num_constraints);
    for (std::size_t i = 0; i < outputs.q.size(); ++i) {
      terms.update_positions(0.0, outputs.q[i]);
      terms.update_jacobian();
      rate.setZero();
      terms.jacobian().add_product(outputs.v[i], rate);
      CHECK(rate.cwiseAbs().maxCoeff() < 1e-12);
    }
    return outputs.statistics.stepper.velocity_violation;
  };
  const double coarse = violation(2e-3), fine = violation(1e-3);
  CHECK(coarse > 1e-6);
  CHECK(coarse / fine == Approx(4.0).margin(0.4));
}

TEST_CASE("A mechanism with a flexible link moves as the other integrators move it", "[analysis]") {
  const FourBar mechanism({1, 2, 3});
  const Outputs reference = run(mechanism.model, mechanism.start, 0.5,
                                {.method = SteppingMethod::kExponential, .relative_tolerance = 1e-9});
  double last = kInfinity;
  for (const double tolerance : {1e-5, 1e-7}) {
    const Outputs outputs =
        run(mechanism.model, mechanism.start, 0.5,
            {.method = SteppingMethod::kGeneralizedAlpha, .relative_tolerance = tolerance});
    const double difference = largest_difference(outputs.q, reference.q);
    INFO("tolerance " << tolerance << ", difference " << difference);
    CHECK(difference < 0.1 * last);
    last = difference;
  }
  CHECK(last < 1e-4);
}

TEST_CASE("The energy of a conservative mechanism changes with the second power of the step", "[analysis]") {
  const FourBar mechanism({});
  const auto energy_range = [&](double length) {
    const Outputs outputs = run(mechanism.model, mechanism.start, 5.0, fixed_steps(length));
    return outputs.highest_energy - outputs.lowest_energy;
  };
  const double coarse = energy_range(2e-3), fine = energy_range(1e-3);
  INFO("energy range " << coarse << " J, " << fine << " J");
  CHECK(coarse / fine > 3.5);
  CHECK(fine < 1e-2);
}

TEST_CASE("Motion to a position that does not exist is refused with the time and the reason", "[analysis]") {
  // Two bars of 1 m; the end of the second is drawn away from the pin of the first: at 2 m they are straight.
  Model model;
  const int first = test::add_body(model, dynamics::make_rigid_body("first", 1.0, 0.1));
  const int second = test::add_body(model, dynamics::make_rigid_body("second", 1.0, 0.1));
  const int pin = test::add_marker(model, dynamics::kGround, {0.0, 0.0});
  const int end = test::add_marker(model, second, {0.5, 0.0});
  test::add_pin(model, "pin", pin, test::add_marker(model, first, {-0.5, 0.0}));
  test::add_pin(model, "knee", test::add_marker(model, first, {0.5, 0.0}),
                test::add_marker(model, second, {-0.5, 0.0}));
  model.joints.push_back(std::make_unique<dynamics::CoordinateJoint>(
      "rope", pin, end, support::SourceLocation{"test.toml", 1, 1},
      dynamics::make_distance_joint(dynamics::TimeFunction::polynomial({1.6, 0.5}))));
  dynamics::number_model(model);
  const double angle = std::acos(0.8);
  VectorXd q(6);
  q << 0.5 * std::cos(angle), 0.5 * std::sin(angle), angle, 1.6 - 0.5 * std::cos(angle),
      0.5 * std::sin(angle), -angle;
  VectorXd v = VectorXd::Zero(6);
  dynamics::project_velocities(model, 0.0, q, v);
  const auto run_beyond = [&] {
    run(model, test::make_state(model, q, v), 1.0, {.method = SteppingMethod::kGeneralizedAlpha});
  };
  CHECK_THROWS_AS(run_beyond(), support::NumericalError);
  CHECK_THROWS_WITH(run_beyond(), Contains("at t = 0.") && Contains("singular"));
}
