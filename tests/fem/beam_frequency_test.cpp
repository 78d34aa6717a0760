#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "fem/assembly.h"
#include "tests/catch.h"
#include "tests/fem/frames.h"
#include "tests/fem/rigid_motions.h"

namespace sprung::fem {

namespace {

// A tilted beam of length L = hypot(1.8, 1.6), stiff enough axially for its first bending modes to come
// first.
constexpr double kBendingRigidity = 1.87e5, kMassPerLength = 13.7;
const double kLength = std::hypot(1.8, 1.6);

BeamModel make_bending_beam(int num_elements) {
  return test::make_straight_beam(
      {0.3, -0.2}, {2.1, 1.4}, num_elements,
      {.axial_rigidity = 1e9, .bending_rigidity = kBendingRigidity, .mass_per_length = kMassPerLength});
}

double calc_frequency(double beta_L_squared) {
  return beta_L_squared / (kLength * kLength) * std::sqrt(kBendingRigidity / kMassPerLength) /
         (2.0 * std::numbers::pi);
}

// Frequencies without the three rigid motions: shifted by a stiffness on them, which are orthogonal to the
// others.
Eigen::VectorXd calc_free_frequencies(const BeamModel& model) {
  const AssembledMatrices assembled = assemble(model);
  const Eigen::MatrixXd MR = assembled.mass * test::calc_rigid_motions(model.mesh, {1.0, 0.5});
  const Eigen::MatrixXd K = Eigen::MatrixXd(assembled.stiffness) + 1e9 * MR * MR.transpose();
  return test::calc_frequencies(K, assembled.mass);
}

Eigen::VectorXd calc_clamped_frequencies(const BeamModel& model) {
  const AssembledMatrices assembled = assemble(model);
  return test::calc_frequencies(test::remove_node(assembled.stiffness, 0),
                                test::remove_node(assembled.mass, 0));
}

// The cantilever of the README: L = 1 m, square of 0.1 m, steel, κ = 5/6.
BeamModel make_thick_cantilever(int num_elements) {
  const double E = 2.1e11, nu = 0.3, rho = 7800.0, side = 0.1;
  const double area = side * side, second_moment = std::pow(side, 4) / 12.0;
  return test::make_straight_beam({0.1, 0.2}, {0.7, 1.0}, num_elements,
                                  {.axial_rigidity = E * area,
                                   .bending_rigidity = E * second_moment,
                                   .shear_rigidity = 5.0 / 6.0 * E / (2.0 * (1.0 + nu)) * area,
                                   .mass_per_length = rho * area,
                                   .rotary_inertia = rho * second_moment});
}

}  // namespace

TEST_CASE("Frequencies of the clamped-free beam converge to the closed form with order 4") {
  // roots of cos βL cosh βL = −1, squared
  const double exact[] = {3.51601526850015, 22.0344915646668, 61.6972144135491};
  const Eigen::VectorXd coarse = calc_clamped_frequencies(make_bending_beam(8));
  const Eigen::VectorXd fine = calc_clamped_frequencies(make_bending_beam(16));
  for (int mode = 0; mode < 3; ++mode) {
    const double coarse_error = coarse[mode] / calc_frequency(exact[mode]) - 1.0;
    const double fine_error = fine[mode] / calc_frequency(exact[mode]) - 1.0;
    CHECK(fine_error > 0.0);
    // (βh)⁴/1440 in the frequency: the error of a consistent Hermite mesh
    const double predicted = exact[mode] * exact[mode] / std::pow(16.0, 4) / 1440.0;
    CHECK(fine_error == Approx(predicted).epsilon(0.15));
    CHECK(std::log2(coarse_error / fine_error) == Approx(4.0).margin(0.1));
  }
}

TEST_CASE("Frequencies of the free-free beam converge to the closed form with order 4") {
  // roots of cos βL cosh βL = +1, squared
  const double exact[] = {22.3732854481, 61.6728228677, 120.903391741};
  const Eigen::VectorXd coarse = calc_free_frequencies(make_bending_beam(16));
  const Eigen::VectorXd fine = calc_free_frequencies(make_bending_beam(32));
  for (int mode = 0; mode < 3; ++mode) {
    const double coarse_error = coarse[mode] / calc_frequency(exact[mode]) - 1.0;
    const double fine_error = fine[mode] / calc_frequency(exact[mode]) - 1.0;
    CHECK(fine_error > 0.0);
    CHECK(fine_error < 1e-5);
    CHECK(std::log2(coarse_error / fine_error) == Approx(4.0).margin(0.1));
  }
}

TEST_CASE("Frequencies of the thick cantilever are those of Timoshenko's equations") {
  // Timoshenko's equations with rotary inertia as a first-order system, the frequencies the zeros of the
  // determinant of its transfer matrix (matrix exponential, bracketed to 1e-9); axial sqrt(E/ρ)/4L.
  const double exact[] = {83.15962533, 498.40434217, 1297.18630416, 1310.87951750, 2377.89341203};
  const Eigen::VectorXd coarse = calc_clamped_frequencies(make_thick_cantilever(32));
  const Eigen::VectorXd fine = calc_clamped_frequencies(make_thick_cantilever(64));
  for (int mode = 0; mode < 5; ++mode) {
    CHECK(fine[mode] > exact[mode]);
    CHECK((4.0 * fine[mode] - coarse[mode]) / 3.0 ==
          Approx(exact[mode]).epsilon(2e-6));  // order 2 extrapolated
    CHECK(std::log2((coarse[mode] / exact[mode] - 1.0) / (fine[mode] / exact[mode] - 1.0)) ==
          Approx(2.0).margin(0.15));
  }
}

TEST_CASE("128 elements give the thick cantilever's frequencies to the README's accuracy") {
  const double expected[] = {83.160, 498.406, 1297.194, 1310.905, 2378.04};
  const Eigen::VectorXd frequencies = calc_clamped_frequencies(make_thick_cantilever(128));
  for (int mode = 0; mode < 5; ++mode) CHECK(frequencies[mode] == Approx(expected[mode]).epsilon(1e-5));
}

TEST_CASE("Renumbering the nodes leaves the frequencies") {
  const BeamModel model = test::make_general_frame();
  const BeamModel other = test::renumber(model, {3, 0, 4, 2, 1});
  const AssembledMatrices a = assemble(model), b = assemble(other);
  const Eigen::VectorXd f_a =
      test::calc_frequencies(test::remove_node(a.stiffness, 0), test::remove_node(a.mass, 0));
  const Eigen::VectorXd f_b =
      test::calc_frequencies(test::remove_node(b.stiffness, 3), test::remove_node(b.mass, 3));
  CHECK(test::calc_difference(f_b, f_a) < 1e-12);
}

}  // namespace sprung::fem
