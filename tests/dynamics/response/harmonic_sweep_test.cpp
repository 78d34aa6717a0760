// A vehicle at many frequencies: uncoupled blocks against a solution of the equations at each, modes held or
// not.
#include "dynamics/response/harmonic_sweep.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <vector>

#include "dynamics/mode_choice/held_response.h"
#include "dynamics/mode_choice/thinned_lines.h"
#include "tests/catch.h"
#include "tests/dynamics/beam_superelement.h"
#include "tests/dynamics/small_models.h"

using namespace sprung;
using dynamics::DrivenSystem;
using dynamics::HarmonicSweep;
using dynamics::RowsXcd;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// y by the equations as they stand.
MatrixXcd solve(const DrivenSystem& system, double omega, const MatrixXcd& forces) {
  const std::complex<double> s(0.0, omega);
  const MatrixXcd Z = system.stiffness + s * system.damping + s * s * system.mass;
  const MatrixXcd x = Z.partialPivLu().solve(system.input * forces);
  MatrixXcd y = system.by_position * x + s * (system.by_velocity * x);
  if (system.by_force.size() > 0) y += system.by_force * forces;
  return y;
}

void check_against_solution(const DrivenSystem& system, bool is_uncoupled) {
  const HarmonicSweep sweep(system);
  CHECK(sweep.is_uncoupled() == is_uncoupled);
  const VectorXd omega = VectorXd::LinSpaced(301, 0.3, 40.0);  // more than one portion
  const MatrixXcd forces = MatrixXcd::Random(system.input.cols(), omega.size());
  const RowsXcd y = sweep.respond(omega, forces);
  for (Eigen::Index i = 0; i < omega.size(); i += 7) {
    const MatrixXcd expected = solve(system, omega[i], forces.col(i));
    REQUIRE((y.col(i) - expected).norm() < 1e-8 * expected.norm());
  }
}

// Two masses in line: k and c to the ground at the first, and between them.
DrivenSystem make_two_masses(double k_ground, double c_ground, double k, double c) {
  DrivenSystem system;
  system.mass = Eigen::Vector2d(2.0, 3.0).asDiagonal();
  system.stiffness = (MatrixXd(2, 2) << k_ground + k, -k, -k, k).finished();
  system.damping = (MatrixXd(2, 2) << c_ground + c, -c, -c, c).finished();
  system.input = MatrixXd::Identity(2, 2);
  system.by_position = (MatrixXd(3, 2) << 1.0, 0.0, 0.0, 1.0, 0.4, -1.0).finished();
  system.by_velocity = (MatrixXd(3, 2) << 0.0, 0.0, 0.3, 0.1, 0.0, 0.2).finished();
  return system;
}

}  // namespace

TEST_CASE("A sweep agrees with a solution of the equations at each frequency", "[choice]") {
  SECTION("two oscillations") {
    check_against_solution(make_two_masses(300.0, 1.0, 800.0, 4.0), true);
  }
  SECTION("one that is overdamped") {
    check_against_solution(make_two_masses(300.0, 90.0, 800.0, 4.0), true);
  }
  SECTION("not connected to the ground") {
    check_against_solution(make_two_masses(0.0, 0.0, 800.0, 4.0), true);
  }
  SECTION("free, but braked") {
    check_against_solution(make_two_masses(0.0, 6.0, 800.0, 4.0), true);
  }
  SECTION("critically damped, where an eigenvector is missing") {
    DrivenSystem system = make_two_masses(18.0, 12.0, 0.0, 0.0);  // c = 2 √(k m) of the first
    system.stiffness(1, 1) = 27.0;
    system.damping(1, 1) = 1.0;
    check_against_solution(system, false);
  }
}

TEST_CASE("A vehicle with held modes moves as the whole one under the holding forces", "[choice]") {
  test::BeamSuperelement frame = test::make_beam_superelement(test::make_crooked_frame(), 5);
  dynamics::Model model;
  const int body =
      test::add_body(model, dynamics::make_flexible_body("frame", frame.superelement, {1, 2, 3, 4, 5}));
  const int tip =
      test::add_node_marker(model, body, frame.superelement, reduce::find_point(frame.superelement, "tip"));
  const int foot =
      test::add_node_marker(model, body, frame.superelement, reduce::find_point(frame.superelement, "foot"));
  test::add_spring(model, "a", tip, test::add_marker(model, dynamics::kGround, {1.3, -1.1}), 1.0, 7e3, 90.0);
  test::add_spring(model, "b", tip, test::add_marker(model, dynamics::kGround, {2.3, 0.4}), 1.0, 7e3, 90.0);
  // The reaction of a joint depends on the holding forces directly.
  test::add_pin(
      model, "pin", foot,
      test::add_marker(model, dynamics::kGround, model.markers[static_cast<std::size_t>(foot)].p_BP));
  dynamics::number_model(model);
  const dynamics::LinearVehicle vehicle(model, VectorXd::Zero(model.num_coordinates));
  dynamics::LinearOutputs outputs = dynamics::make_point_outputs(vehicle, tip);
  outputs.append(dynamics::make_reaction_outputs(vehicle));
  const std::vector<int> coordinates{3, 4, 5, 6, 7};
  const dynamics::HeldResponseSolver solver(vehicle, outputs, coordinates);
  const Eigen::VectorXcd channels = Eigen::VectorXcd::Zero(vehicle.channel_rows().back());
  const Eigen::VectorXcd force =
      VectorXd::LinSpaced(model.num_coordinates, -1.0, 2.0).cast<std::complex<double>>();
  const VectorXd omega = VectorXd::Constant(1, 2.0 * std::numbers::pi * 7.0);
  const MatrixXcd reduced = vehicle.system().directions.transpose() * force;
  const MatrixXcd whole = HarmonicSweep(make_held_system(vehicle, outputs, {})).respond(omega, reduced);
  for (const std::vector<int>& set : {std::vector<int>{1}, {3, 0}, {2, 4, 1}, {0, 1, 2, 3, 4}}) {
    std::vector<int> held;
    for (const int mode : set) held.push_back(coordinates[static_cast<std::size_t>(mode)]);
    const MatrixXcd change =
        HarmonicSweep(make_held_system(vehicle, outputs, held)).respond(omega, reduced) - whole;
    const Eigen::VectorXcd expected = dynamics::calc_change(solver.solve(omega[0], force, channels), set);
    REQUIRE(expected.norm() > 0.0);
    CHECK((change - expected).norm() < 1e-7 * expected.norm());
  }
}

TEST_CASE("The intervals of thinned lines cover all lines", "[choice]") {
  const MatrixXcd amplitudes = MatrixXcd::Random(2, 500);
  const dynamics::ThinnedLines thinned = dynamics::thin_lines(amplitudes, 0.05);
  CHECK(thinned.size() < 150);
  CHECK(thinned.lines.front() == 0);
  CHECK(thinned.lines.back() == 499);
  CHECK(thinned.lines[10] == 10);
  CHECK(thinned.ends.back() == 500);
  MatrixXcd sum = MatrixXcd::Zero(2, 2);
  for (const MatrixXcd& power : thinned.powers) sum += power;
  const MatrixXcd all = amplitudes * amplitudes.adjoint();
  CHECK((sum - all).norm() < 1e-12 * all.norm());
  // Σ |g a|² of one output over all lines.
  const MatrixXcd gains = MatrixXcd::Random(3, 2);
  const VectorXd powers = dynamics::calc_powers(gains, all);
  for (Eigen::Index row = 0; row < 3; ++row) {
    CHECK(powers[row] == Approx((gains.row(row) * amplitudes).squaredNorm()));
  }
}
