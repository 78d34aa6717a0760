#include "dynamics/bodies/modal_matrix.h"

#include <Eigen/Core>
#include <limits>

#include "tests/catch.h"

using namespace sprung;

// Eigen's product is the expected one; the entries that count as rounding errors are a trillionth of it.
TEST_CASE("A modal matrix multiplies as its matrix does, and knows where only its diagonal counts",
          "[bodies]") {
  const Eigen::VectorXd sizes = Eigen::Vector4d(1.0, 4.0, 1e6, 9.0);
  const Eigen::VectorXd x = Eigen::Vector4d(0.3, -1.2, 2e-3, 0.7);
  const auto check = [&](const Eigen::MatrixXd& matrix, bool is_diagonal, bool is_zero) {
    const dynamics::ModalMatrix modal(matrix, sizes);
    CHECK(modal.is_diagonal() == is_diagonal);
    CHECK(modal.is_zero() == is_zero);
    Eigen::VectorXd y = Eigen::VectorXd::Constant(4, std::numeric_limits<double>::quiet_NaN());
    modal.multiply(x.data(), y.data());
    CHECK((y - matrix * x).norm() < 1e-11 * sizes.norm());
  };
  Eigen::MatrixXd matrix = sizes.asDiagonal();
  check(matrix, true, false);
  matrix(1, 2) = matrix(2, 1) = 1e-12 * 1e3;  // of √(4 · 1e6)
  check(matrix, true, false);
  matrix(0, 3) = matrix(3, 0) = 1e-11;
  check(matrix, false, false);
  check(1e-13 * sizes.asDiagonal().toDenseMatrix(), true, true);
  Eigen::MatrixXd skew = Eigen::MatrixXd::Zero(4, 4);
  skew(0, 1) = 2.0;
  skew(1, 0) = -2.0;
  check(skew, false, false);
}

TEST_CASE("A matrix of no modes has no product", "[bodies]") {
  const dynamics::ModalMatrix none(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0));
  CHECK(none.is_zero());
  none.multiply(nullptr, nullptr);
}
