#include "reduce/factors/sparse_factor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/stiffness_factor.h"
#include "reduce/reduction/body_basis.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

std::vector<FactorMethod> list_methods() {
  if (has_cholmod()) return {FactorMethod::kSimplicial, FactorMethod::kSupernodal};
  return {FactorMethod::kSimplicial};
}

// 70 columns: more than one block. Expected: dense solutions.
TEST_CASE("factors by Eigen and by supernodes solve one and many right-hand sides") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const ModalProblem problem = testing::make_modal_problem(testing::make_random_frame(seed), 2);
    const Eigen::MatrixXd x = Eigen::MatrixXd::Random(problem.size(), 70);
    const SparseMatrix shifted = problem.stiffness - 1e4 * problem.mass;
    for (const FactorMethod method : list_methods()) {
      for (const bool is_definite : {true, false}) {
        const SparseMatrix& A = is_definite ? problem.stiffness : shifted;
        const auto factor = make_sparse_factor(A, is_definite, method);
        REQUIRE(factor != nullptr);
        const Eigen::MatrixXd expected = Eigen::MatrixXd(A).fullPivLu().solve(x);
        CHECK((factor->solve(x) - expected).norm() < 1e-8 * expected.norm());
        CHECK((factor->solve(x.leftCols(1)) - expected.leftCols(1)).norm() < 1e-8 * expected.norm());
        CHECK(factor->solve(x.leftCols(0)).size() == 0);
      }
    }
  }
}

// Expected: eigenvalues of the dense matrix.
TEST_CASE("the negative pivots are as many as the negative eigenvalues, in any order of elimination") {
  for (const std::uint64_t seed : {4, 5}) {
    const ModalProblem problem = testing::make_modal_problem(testing::make_random_frame(seed), 1);
    const Eigen::VectorXd omega_squared =
        Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(problem.stiffness, problem.mass)
            .eigenvalues();
    for (const Eigen::Index below : {0, 3, 10}) {
      const double shift = 0.5 * (omega_squared(below) + omega_squared(below + 1));
      const SparseMatrix A = problem.stiffness - shift * problem.mass;
      for (const FactorMethod method : list_methods()) {
        const auto factor = make_sparse_factor(A, false, method);
        CHECK(factor->num_negative() == below + 1);
        const auto stiffness = make_sparse_factor(problem.stiffness, true, method);
        CHECK(stiffness->num_negative() == 0);
        CHECK(stiffness->factor_like(A)->num_negative() == below + 1);
      }
    }
  }
}

// A supernode of every width and height that a chain, a grid and a dense matrix have, and more pivots of both
// signs than one panel has. Expected: the product with the matrix gives the right-hand side back.
TEST_CASE("supernodal factors solve chains, grids and dense matrices, definite or not") {
  if (!has_cholmod()) return;
  for (const int bandwidth : {1, 2, 9, 70}) {
    const int n = 71;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    for (int j = 0; j < n; ++j) {
      for (int i = j; i < std::min(n, j + bandwidth + 1); ++i)
        A(i, j) = A(j, i) = std::sin(1.0 + i * 1.7 + j * j);
      A(j, j) = 3.0 * bandwidth;
    }
    for (const bool is_definite : {true, false}) {
      if (!is_definite) {
        for (int j = 0; j < n; j += 3) A(j, j) *= -1.0;
      }
      const auto factor = make_sparse_factor(A.sparseView(), is_definite, FactorMethod::kSupernodal);
      REQUIRE(factor != nullptr);
      CHECK(factor->num_negative() == (is_definite ? 0 : 24));
      for (const int columns : {1, 3, 4, 5, 8, 13}) {
        const Eigen::MatrixXd x = Eigen::MatrixXd::Random(n, columns);
        CHECK((A * factor->solve(x) - x).norm() < 1e-12 * x.norm());
      }
    }
  }
}

TEST_CASE("a matrix that is singular, or not definite where it has to be, has no factors") {
  const ModalProblem problem = testing::make_modal_problem(testing::make_random_frame(6), 0);
  const SparseMatrix indefinite = problem.stiffness - 1e6 * problem.mass;
  SparseMatrix singular(3, 3);
  singular.insert(0, 0) = 1.0;
  singular.insert(2, 2) = 1.0;
  for (const FactorMethod method : list_methods()) {
    CHECK(make_sparse_factor(indefinite, true, method) == nullptr);
    CHECK(make_sparse_factor(singular, true, method) == nullptr);
    CHECK(make_sparse_factor(singular, false, method) == nullptr);
  }
  if (!has_cholmod()) {
    CHECK_THROWS_AS(make_sparse_factor(indefinite, false, FactorMethod::kSupernodal), std::invalid_argument);
  }
}

// More freedoms than kMostSimplicial, so that supernodal factors count, where CHOLMOD is there, in the order
// of the stiffness. Expected: Eigen's factors of the held frame; free modes by the inertia of [A, σQ; σQᵀ,
// −σI], which is that of A and of −σI − σ²QᵀA⁻¹Q.
TEST_CASE("the modes of a large frame are counted as by Eigen's factors, held and free") {
  constexpr int kCells = 82;
  Design design = testing::make_design(testing::make_lattice(kCells, kCells), {41.0, 41.0}, {});
  const BodyMatrices matrices = make_body_matrices(design);
  const ModalProblem held = matrices.make_held();
  REQUIRE(held.size() > kMostSimplicial);
  const Eigen::MatrixXd load = Eigen::MatrixXd::Random(held.size(), 40);
  const Eigen::MatrixXd back = held.stiffness * matrices.factor->solve(load);
  CHECK((back - load).norm() < 1e-6 * load.norm());
  for (const double hz : {2.0, 5.0}) {
    const double shift = std::pow(2.0 * std::numbers::pi * hz, 2);
    const SparseMatrix A = held.stiffness - shift * held.mass;
    const auto factor = make_sparse_factor(A, false, FactorMethod::kSimplicial);
    CHECK(count_modes_below(held, shift) == factor->num_negative());
    const Eigen::MatrixXd& Q = matrices.free.rigid_share;
    const Eigen::Matrix3d corner =
        -shift * Eigen::Matrix3d::Identity() - shift * shift * Q.transpose() * factor->solve(Q);
    const auto num_negative =
        static_cast<int>((corner.selfadjointView<Eigen::Lower>().eigenvalues().array() < 0.0).count());
    const int expected = factor->num_negative() + num_negative - 3;
    CHECK(expected > 0);
    CHECK(count_modes_below(matrices.free, shift) == expected);
  }
}

}  // namespace
}  // namespace sprung::reduce
