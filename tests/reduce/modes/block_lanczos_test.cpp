#include "reduce/modes/block_lanczos.h"

#include <algorithm>
#include <numbers>

#include "reduce/modes/dense_eigen_solver.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/modes_below.h"
#include "reduce/reduction/body_basis.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {
namespace {

ModalProblem make_diagonal(const Eigen::VectorXd& stiffness, const Eigen::VectorXd& mass) {
  ModalProblem problem;
  problem.stiffness = Eigen::MatrixXd(stiffness.asDiagonal()).sparseView();
  problem.mass = Eigen::MatrixXd(mass.asDiagonal()).sparseView();
  return problem;
}

double calc_largest_error(const Eigen::VectorXd& found, const Eigen::VectorXd& expected) {
  return (found.cwiseQuotient(expected).array() - 1.0).abs().maxCoeff();
}

// Expected: the dense solution, another algorithm, of the same frame, held and free.
TEST_CASE("blocks give the modes of the dense solution, orthonormal, held and free") {
  const Design design = testing::make_design(testing::make_lattice(8, 6), {4.0, 3.0}, {});
  const BodyMatrices matrices = make_body_matrices(design);
  const ModalProblem held = matrices.make_held();
  const Eigen::Index n = held.size();
  for (const ModalProblem* problem : {&held, &matrices.free}) {
    for (const int num_pairs : {1, 7, 25}) {
      const EigenPairs pairs = solve_by_blocks(*problem, *matrices.factor, num_pairs, 1);
      const EigenPairs dense =
          solve_dense(problem->stiffness, problem->times_mass(Eigen::MatrixXd::Identity(n, n)));
      CAPTURE(num_pairs, problem->is_free());
      CHECK(calc_largest_error(pairs.omega_squared, dense.omega_squared.head(num_pairs)) < 1e-9);
      const Eigen::MatrixXd gram = pairs.vectors.transpose() * problem->times_mass(pairs.vectors);
      CHECK((gram - Eigen::MatrixXd::Identity(num_pairs, num_pairs)).cwiseAbs().maxCoeff() < 1e-12);
      const Eigen::MatrixXd inertia = problem->times_mass(pairs.vectors) * pairs.omega_squared.asDiagonal();
      CHECK((pairs.vectors - matrices.factor->solve(inertia)).norm() < 1e-9 * pairs.vectors.norm());
    }
  }
}

// Expected: the diagonal itself, each value four times.
TEST_CASE("a block finds four modes of one frequency") {
  Eigen::VectorXd omega_squared(400);
  for (Eigen::Index i = 0; i < omega_squared.size(); ++i) omega_squared(i) = 1.0 + static_cast<double>(i / 4);
  const ModalProblem problem = make_diagonal(omega_squared, Eigen::VectorXd::Ones(400));
  const EigenPairs pairs = solve_by_blocks(problem, StiffnessFactor(problem.stiffness), 12, 5);
  CHECK(calc_largest_error(pairs.omega_squared, omega_squared.head(12)) < 1e-12);
}

// Expected: the dense solution. How many are below is not told.
TEST_CASE("blocks give all modes below a frequency, and the frequencies of some beyond") {
  const Design design = testing::make_design(testing::make_lattice(8, 6), {4.0, 3.0}, {});
  const BodyMatrices matrices = make_body_matrices(design);
  const Eigen::Index n = matrices.free.size();
  const EigenPairs dense =
      solve_dense(matrices.free.stiffness, matrices.free.times_mass(Eigen::MatrixXd::Identity(n, n)));
  for (const Eigen::Index num_below : {0, 4, 11}) {
    const double below =
        0.5 * (dense.omega_squared(num_below) + (num_below > 0 ? dense.omega_squared(num_below - 1) : 0.0));
    const EigenPairs pairs =
        solve_by_blocks(matrices.free, *matrices.factor, {.below = below, .beyond = 3}, 1);
    CAPTURE(num_below);
    REQUIRE(pairs.omega_squared.size() == num_below + 3);
    CHECK(calc_largest_error(pairs.omega_squared, dense.omega_squared.head(num_below + 3)) < 1e-9);
  }
}

// A frame so large that the iteration itself finds how many modes are below a frequency. Expected: their
// count before it, and the lowest modes as they are asked for by number.
TEST_CASE("the modes of a large frame below a frequency are counted once, and all are there") {
  const Design design = testing::make_design(testing::make_lattice(82, 82), {41.0, 41.0}, {});
  const BodyMatrices matrices = make_body_matrices(design);
  REQUIRE(matrices.free.size() > kMostSimplicial);
  const double hz = 5.0, omega = 2.0 * std::numbers::pi * hz;
  const ModesBelow below = calc_modes_below(matrices.free, hz);
  const int counted = count_modes_below(matrices.free, omega * omega);
  REQUIRE(counted > 3);
  CHECK(below.cluster.size() == counted);
  CHECK(below.num_missing == 0);
  const ClampedModes lowest = calc_clamped_modes(matrices.free, counted + 1);
  CHECK(calc_largest_error(below.pairs.omega_squared, lowest.pairs.omega_squared.head(counted)) < 1e-11);
  CHECK(below.next_omega_squared == Approx(lowest.pairs.omega_squared(counted)).epsilon(1e-11));
  const Eigen::MatrixXd gram =
      below.pairs.vectors.transpose() * matrices.free.times_mass(below.pairs.vectors);
  CHECK((gram - Eigen::MatrixXd::Identity(counted, counted)).cwiseAbs().maxCoeff() < 1e-11);
}

TEST_CASE("freedoms without mass take no part") {
  Eigen::VectorXd mass = Eigen::VectorXd::Ones(60);
  mass.head(20).setZero();
  ModalProblem problem = make_diagonal(Eigen::VectorXd::LinSpaced(60, 1.0, 60.0), mass);
  problem.num_massless = 20;
  const EigenPairs pairs = solve_by_blocks(problem, StiffnessFactor(problem.stiffness), 39, 2);
  CHECK(calc_largest_error(pairs.omega_squared, Eigen::VectorXd::LinSpaced(39, 21.0, 59.0)) < 1e-11);
}

TEST_CASE("more modes than a space of blocks holds are refused") {
  const ModalProblem problem = make_diagonal(Eigen::VectorXd::Constant(40, 9.0),
                                             Eigen::VectorXd::Ones(40));  // one frequency: one block
  CHECK_THAT(testing::message_of<support::NumericalError>(
                 [&] { solve_by_blocks(problem, StiffnessFactor(problem.stiffness), 6, 1); }),
             Contains("6 were not found with 4 vectors"));
}

}  // namespace
}  // namespace sprung::reduce
