#include "dynamics/linear/undamped_modes.h"

#include <Eigen/Core>
#include <cmath>

#include "dynamics/linear/first_order_form.h"
#include "tests/catch.h"

using namespace sprung;
using dynamics::UndampedModes;
using Eigen::MatrixXd;

TEST_CASE("A soft mode beside one of 100 kHz keeps all its digits", "[analysis]") {
  // det(K − λM) = 0 is a quadratic equation; its smaller root in long double, by the product of the roots.
  const long double a = 4e14L, b = 2e3L, d = 40.0L, m = 0.3L;
  MatrixXd K(2, 2), M(2, 2);
  K << 4e14, 2e3, 2e3, 40.0;
  M << 1.0, 0.3, 0.3, 2.0;
  const long double A = 2.0L - m * m, B = 2.0L * a + d - 2.0L * m * b, C = a * d - b * b;
  const long double soft = 2.0L * C / (B + std::sqrt(B * B - 4.0L * A * C));
  const UndampedModes modes = dynamics::calc_undamped_modes(K, M, dynamics::calc_matrix_rounding(K));
  CHECK(modes.omega_squared[0] == Approx(static_cast<double>(soft)).epsilon(1e-13));
  CHECK_FALSE(modes.is_free(0));
  CHECK((modes.vectors.transpose() * M * modes.vectors - MatrixXd::Identity(2, 2)).norm() < 1e-14);
}

TEST_CASE("Directions without stiffness beside a stiff spring are recognised by rounding", "[analysis]") {
  // K = S v vᵀ holds one direction of three.
  const Eigen::Vector3d v(1.0, -0.7, 0.2);
  const MatrixXd K = 4e14 * v * v.transpose(), M = Eigen::Vector3d(3.0, 0.2, 5.0).asDiagonal();
  const UndampedModes modes = dynamics::calc_undamped_modes(K, M, dynamics::calc_matrix_rounding(K));
  int num_free = 0;
  for (Eigen::Index k = 0; k < 3; ++k) num_free += modes.is_free(k) ? 1 : 0;
  CHECK(num_free == 2);
  CHECK(modes.omega_squared.maxCoeff() ==
        Approx(4e14 * (1.0 / 3.0 + 0.49 / 0.2 + 0.04 / 5.0)).epsilon(1e-12));
}

TEST_CASE("A system is unstable if a real part is above rounding", "[analysis]") {
  Eigen::VectorXcd s(2);
  s << std::complex<double>(-1.0, 1e5), std::complex<double>(1e-6, 2.0);
  CHECK_FALSE(dynamics::has_growth(s));
  s[1] = {1e-2, 2.0};  // 0.01 1/s beside 1e5 rad/s
  CHECK(dynamics::has_growth(s));
}
