#include "dynamics/linear/frequency_solver.h"

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "tests/catch.h"
#include "tests/dynamics/random_numbers.h"
#include "tools/support/errors/numerical_error.h"

using namespace sprung;
using dynamics::FrequencySolver;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

namespace {

MatrixXd make_random(test::RandomNumbers& random, Eigen::Index rows, Eigen::Index columns) {
  return random.vector(rows * columns, 1.0).reshaped(rows, columns);
}

// A second algorithm: the dense matrix of each frequency by itself.
MatrixXcd solve_directly(const MatrixXd& M, const MatrixXd& C, const MatrixXd& K, double omega,
                         const MatrixXcd& F) {
  const MatrixXcd Z = (K - omega * omega * M) + std::complex<double>(0.0, omega) * C;
  return Z.partialPivLu().solve(F);
}

double relative_difference(const MatrixXcd& a, const MatrixXcd& b) {
  return (a - b).norm() / b.norm();
}

}  // namespace

TEST_CASE("Frequency response agrees with a dense solution at each frequency", "[analysis]") {
  test::RandomNumbers random(11);
  const Eigen::Index f = 9;
  const MatrixXd root = make_random(random, f, f), elastic = make_random(random, f, f);
  const MatrixXd M = root * root.transpose() + MatrixXd::Identity(f, f);
  // The matrices are not symmetric and are not diagonal in the undamped modes; stiffness over six decades.
  const Eigen::VectorXd spread =
      Eigen::VectorXd::LinSpaced(f, 0.0, 6.0).unaryExpr([](double e) { return std::pow(10.0, e); });
  const MatrixXd K = elastic * spread.asDiagonal() * elastic.transpose() + 0.3 * make_random(random, f, f);
  const MatrixXd C = make_random(random, f, f) + 20.0 * MatrixXd::Identity(f, f);
  const MatrixXcd F = make_random(random, f, 2) + std::complex<double>(0.0, 1.0) * make_random(random, f, 2);
  const FrequencySolver solver(M, C, K);
  for (const double omega : {0.01, 0.3, 2.0, 17.0, 140.0, 5000.0}) {
    CAPTURE(omega);
    CHECK(relative_difference(solver.solve(omega, F), solve_directly(M, C, K, omega, F)) < 1e-10);
  }
}

TEST_CASE("Critical damping, where eigenvectors are missing, and free masses are handled", "[analysis]") {
  // Two oscillators damped critically, coupled one way so that s = −3 is fourfold, and a mass that nothing
  // holds.
  MatrixXd M = MatrixXd::Identity(3, 3), C = MatrixXd::Zero(3, 3), K = MatrixXd::Zero(3, 3);
  C.diagonal() << 6.0, 6.0, 0.0;
  K.diagonal() << 9.0, 9.0, 0.0;
  K(0, 1) = 2.0;
  const FrequencySolver solver(M, C, K);
  const MatrixXcd F = MatrixXcd::Identity(3, 3);
  for (const double omega : {0.05, 3.0, 40.0}) {
    CAPTURE(omega);
    const MatrixXcd x = solver.solve(omega, F);
    const std::complex<double> s(0.0, omega), critical = 1.0 / ((s + 3.0) * (s + 3.0));
    CHECK(std::abs(x(0, 0) - critical) < 1e-13);
    CHECK(std::abs(x(0, 1) + 2.0 * critical * critical) < 1e-13);
    CHECK(std::abs(x(2, 2) * s * s - 1.0) < 1e-12);
    CHECK(std::abs(x(1, 0)) < 1e-15);
  }
}

TEST_CASE("Soft modes beside stiff ones keep their accuracy", "[analysis]") {
  // 1 Hz beside 100 kHz, damped together: the soft one's static displacement to 1e-12.
  MatrixXd M = MatrixXd::Identity(2, 2), C(2, 2), K = MatrixXd::Zero(2, 2);
  C << 0.4, 0.1, 0.1, 900.0;
  K.diagonal() << 39.5, 4e11;
  const FrequencySolver solver(M, C, K);
  const MatrixXcd F = MatrixXcd::Constant(2, 1, 1.0);
  for (const double omega : {1e-3, 6.0, 200.0}) {
    CHECK(relative_difference(solver.solve(omega, F), solve_directly(M, C, K, omega, F)) < 1e-12);
  }
}

TEST_CASE("The frequency solver refuses what it cannot solve", "[analysis]") {
  const MatrixXd I = MatrixXd::Identity(2, 2);
  CHECK_THROWS_WITH(FrequencySolver(I, I, MatrixXd::Identity(3, 3)), Contains("got 3×3"));
  CHECK_THROWS_AS(FrequencySolver(-I, I, I), support::NumericalError);
  CHECK_THROWS_WITH(FrequencySolver(I, I, I).solve(0.0, MatrixXcd::Identity(2, 2)),
                    Contains("omega must be > 0"));
}
