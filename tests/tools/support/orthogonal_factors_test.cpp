#include "tools/support/dense/orthogonal_factors.h"

#include <cmath>

#include "tests/catch.h"

using namespace sprung;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Singular values √45 and √5: AᵀA = [25 20; 20 25] has the eigenvalues 45 and 5.
MatrixXd make_known_matrix() {
  return (MatrixXd(2, 2) << 3.0, 0.0, 4.0, 5.0).finished();
}

}  // namespace

TEST_CASE("The basis of a column space is orthonormal and begins with what spans the columns", "[support]") {
  // The third column is the sum of the others.
  const MatrixXd A =
      (MatrixXd(4, 3) << 1.0, 2.0, 3.0, 0.0, 1.0, 1.0, -1.0, 0.5, -0.5, 2.0, 0.0, 2.0).finished();
  const support::ColumnSpace space = support::find_column_space(A, 4);
  CHECK(space.rank == 2);
  CHECK((space.basis.transpose() * space.basis - MatrixXd::Identity(4, 4)).norm() < 1e-14);
  const MatrixXd outside = space.basis.rightCols(2).transpose() * A;
  CHECK(outside.norm() < 1e-14 * A.norm());
  CHECK((support::find_column_space(A, 3).basis - space.basis.leftCols(3)).norm() == 0.0);
}

TEST_CASE("A rotation onto a vector has its direction as first column", "[support]") {
  const VectorXd direction = (VectorXd(3) << 2.0, -3.0, 6.0).finished();  // of length 7
  const MatrixXd rotation = support::make_rotation_onto(direction);
  CHECK((rotation.transpose() * rotation - MatrixXd::Identity(3, 3)).norm() < 1e-15);
  CHECK(std::abs(rotation.col(0).dot(direction)) == Approx(7.0).epsilon(1e-14));
}

TEST_CASE("Too many equations are solved for the least residual, too few by the shortest solution",
          "[support]") {
  // x = 1 and x = 3: the mean. x + y = 2: half of it each.
  const MatrixXd x =
      support::solve_least_squares(MatrixXd::Ones(2, 1), (MatrixXd(2, 1) << 1.0, 3.0).finished());
  CHECK(x(0, 0) == Approx(2.0).epsilon(1e-14));
  const VectorXd xy = support::solve_least_squares(MatrixXd::Ones(1, 2), VectorXd::Constant(1, 2.0));
  CHECK((xy - VectorXd::Ones(2)).norm() < 1e-14);
  // The same equation twice, which leaves the rank 1.
  const VectorXd twice = support::solve_least_squares(MatrixXd::Ones(2, 2), VectorXd::Constant(2, 2.0));
  CHECK((twice - VectorXd::Ones(2)).norm() < 1e-14);
}

TEST_CASE("Singular values descend and belong to their vectors", "[support]") {
  const MatrixXd A = make_known_matrix();
  const VectorXd values = support::calc_singular_values(A);
  CHECK(values[0] == Approx(std::sqrt(45.0)).epsilon(1e-14));
  CHECK(values[1] == Approx(std::sqrt(5.0)).epsilon(1e-14));
  const support::SingularPairs right = support::calc_right_singular_pairs(A);
  CHECK((right.values - values).norm() < 1e-14);
  CHECK((A.transpose() * A * right.vectors - right.vectors * values.cwiseAbs2().asDiagonal()).norm() <
        1e-13 * 45.0);
  const support::SingularPairs left = support::calc_left_singular_pairs(A);
  CHECK((A * A.transpose() * left.vectors - left.vectors * values.cwiseAbs2().asDiagonal()).norm() <
        1e-13 * 45.0);
  // One column: the left vectors beyond the first are orthogonal to it.
  const support::SingularPairs completed = support::calc_left_singular_pairs(A.leftCols(1));
  REQUIRE(completed.vectors.cols() == 2);
  CHECK(std::abs(completed.vectors.col(1).dot(A.col(0))) < 1e-14);
}
