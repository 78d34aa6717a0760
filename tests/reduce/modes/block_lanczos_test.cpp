#include "reduce/modes/block_lanczos.h"

#include <algorithm>

#include "reduce/modes/dense_eigen_solver.h"
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
  const Eigen::Index n = matrices.held.size();
  for (const ModalProblem* problem : {&matrices.held, &matrices.free}) {
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
