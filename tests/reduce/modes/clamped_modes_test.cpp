#include "reduce/modes/clamped_modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "reduce/modes/clusters.h"
#include "reduce/modes/dense_eigen_solver.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/rounding_error.h"
#include "reduce/modes/sparse_eigen_solver.h"
#include "tests/catch.h"
#include "tests/reduce/test_bodies.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {
namespace {

using support::NumericalError;
using testing::message_of;

// A tilted cantilever of 3 m.
ModalProblem make_cantilever(int num_elements) {
  fem::BeamModel model = testing::make_model();
  testing::add_line(model, {0.2, 0.1},
                    Eigen::Vector2d(0.2, 0.1) + 3.0 * Eigen::Vector2d(std::cos(0.3), std::sin(0.3)),
                    num_elements);
  return testing::make_modal_problem(model, 0);
}

ModalProblem make_diagonal_problem(const Eigen::VectorXd& omega_squared) {
  ModalProblem problem;
  problem.stiffness = Eigen::MatrixXd(omega_squared.asDiagonal()).sparseView();
  problem.mass = Eigen::MatrixXd::Identity(omega_squared.size(), omega_squared.size()).sparseView();
  return problem;
}

double calc_residual(const ModalProblem& problem, const EigenPairs& pairs) {
  const Eigen::MatrixXd error =
      problem.stiffness * pairs.vectors - problem.mass * pairs.vectors * pairs.omega_squared.asDiagonal();
  return error.norm() / (problem.stiffness * pairs.vectors).norm();
}

TEST_CASE("the first bending modes of a slender cantilever have (βL)² 3.516, 22.03, 61.70") {
  const fem::BeamProperties section = testing::make_section();
  const double scale = std::sqrt(section.bending_rigidity / section.mass_per_length) / 9.0;
  const ClampedModes modes = calc_clamped_modes(make_cantilever(60), 3);
  const double expected[] = {3.51601527, 22.03449156, 61.69721441};  // roots of cos βL cosh βL = −1
  for (int i = 0; i < 3; ++i)
    CHECK(std::sqrt(modes.pairs.omega_squared(i)) / scale == Approx(expected[i]).epsilon(1e-6));
}

TEST_CASE("both solvers satisfy K φ = ω² M φ with orthonormal modes") {
  const ModalProblem problem = make_cantilever(40);
  for (const EigenPairs& pairs :
       {solve_dense(problem.stiffness, problem.mass), solve_sparse(problem, 15, 3)}) {
    CHECK(calc_residual(problem, pairs) < 1e-11);
    const Eigen::MatrixXd gram = pairs.vectors.transpose() * (problem.mass * pairs.vectors);
    CHECK((gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff() < 1e-13);
    CHECK(std::is_sorted(pairs.omega_squared.begin(), pairs.omega_squared.end()));
  }
}

TEST_CASE("the sparse solver gives the dense one's modes for a beam of 250 elements") {
  const ModalProblem problem = make_cantilever(250);
  const ClampedModes dense = calc_clamped_modes(problem, 12, {.method = EigenMethod::kDense});
  const ClampedModes sparse = calc_clamped_modes(problem, 12, {.method = EigenMethod::kSparse, .seed = 7});
  const double rounding =
      estimate_rounding_error(problem.stiffness, dense.pairs.vectors.col(0), dense.pairs.omega_squared(0));
  REQUIRE(rounding < 3e-6);  // what two methods may differ by in the lowest mode; the higher ones suffer less
  CHECK((dense.pairs.omega_squared.cwiseQuotient(sparse.pairs.omega_squared).array() - 1.0).abs().maxCoeff() <
        rounding);
  const Eigen::MatrixXd alike = dense.pairs.vectors.transpose() * (problem.mass * sparse.pairs.vectors);
  CHECK((alike.cwiseAbs() - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff() < 10.0 * rounding);
}

TEST_CASE("the dense solver keeps the relative accuracy of modes over eight decades of frequency") {
  Eigen::VectorXd omega_squared(5);
  omega_squared << 1e-8, 1e-4, 1.0, 1e4, 1e8;
  // A congruence with a dense matrix leaves the eigenvalues of the pair as they are.
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(5, 5);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < i; ++j) S(i, j) = std::sin(3.0 * i + j);
  }
  const EigenPairs pairs = solve_dense(S * omega_squared.asDiagonal() * S.transpose(), S * S.transpose());
  CHECK((pairs.omega_squared.cwiseQuotient(omega_squared).array() - 1.0).abs().maxCoeff() < 1e-6);
  CHECK(std::abs(pairs.omega_squared(0) / omega_squared(0) - 1.0) < 1e-6);
}

TEST_CASE("every repeated mode is found, whatever the start vector") {
  for (const int num_arms : {2, 4, 6}) {
    const ModalProblem problem = testing::make_modal_problem(testing::make_star(num_arms, 0.3), 0);
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      const ClampedModes modes =
          calc_clamped_modes(problem, 1, {.method = EigenMethod::kSparse, .seed = seed});
      CAPTURE(num_arms, seed);
      CHECK(modes.pairs.omega_squared.size() == num_arms);
      CHECK(modes.num_below == num_arms);
      CHECK(modes.cluster == Eigen::VectorXi::Ones(num_arms));
    }
  }
}

TEST_CASE("the count shows a basis from which a member of a pair was left out") {
  const ModalProblem problem = testing::make_modal_problem(testing::make_star(2, 0.0, 8), 0);
  const EigenPairs all = solve_dense(problem.stiffness, problem.mass);
  const double shift = 0.5 * (all.omega_squared(3) + all.omega_squared(4));
  Eigen::VectorXd incomplete(5);  // what an iteration returns that missed mode 2
  incomplete << all.omega_squared(0), all.omega_squared.segment(2, 4);
  CHECK((incomplete.array() < shift).count() == 3);
  CHECK(count_modes_below(problem, shift) == 4);
}

TEST_CASE("solutions that lack a member of a pair are not proved, wherever it is missing") {
  const ModalProblem problem = testing::make_modal_problem(testing::make_star(2, 0.0, 8), 0);
  const EigenPairs all = solve_dense(problem.stiffness, problem.mass);
  const auto prove_without = [&](int missing, int num_modes) {
    std::vector<int> left;
    for (int i = 0; i < 12; ++i) {
      if (i != missing) left.push_back(i);
    }
    return prove_complete(problem, {all.omega_squared(left), all.vectors(Eigen::all, left)}, num_modes);
  };
  for (int num_modes = 1; num_modes <= 8; ++num_modes) {
    const int end = 2 * ((num_modes + 1) / 2);
    const ModeProof complete = prove_without(11, num_modes);
    REQUIRE(complete.modes);
    CHECK(complete.modes->pairs.omega_squared.size() == end);
    for (int missing = 0; missing < end; ++missing) {
      CAPTURE(num_modes, missing);
      const ModeProof proof = prove_without(missing, num_modes);
      CHECK_FALSE(proof.modes);
      CHECK_THAT(proof.reason, Contains("counted"));
    }
  }
  CHECK_THAT(prove_complete(problem, {all.omega_squared.head(3), all.vectors.leftCols(3)}, 3).reason,
             Contains("goes on after mode 3"));
}

TEST_CASE("the count agrees with the solver between all modes of a frame") {
  const ModalProblem problem = testing::make_modal_problem(testing::make_spoked_square(0.21), 0);
  const EigenPairs all = solve_dense(problem.stiffness, problem.mass);
  const Eigen::VectorXi cluster = find_clusters(all.omega_squared);
  CHECK(count_modes_below(problem, 0.5 * all.omega_squared(0)) == 0);
  for (Eigen::Index i = 0; i + 1 < cluster.size(); ++i) {
    if (cluster(i) == cluster(i + 1)) continue;
    CHECK(count_modes_below(problem, std::sqrt(all.omega_squared(i) * all.omega_squared(i + 1))) == i + 1);
  }
}

TEST_CASE("a count at a mode's own frequency is refused, or correct for one side") {
  const ModalProblem problem = make_diagonal_problem(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0));
  CHECK_THAT(message_of<NumericalError>([&] { count_modes_below(problem, 2.0); }),
             Contains("could not be factored"));
  CHECK(count_modes_below(problem, 2.0 - 1e-9) == 1);
  CHECK(count_modes_below(problem, 2.0 + 1e-9) == 2);
}

TEST_CASE("neighbours within a relative gap of 1e-6 in frequency form a cluster") {
  const double f[] = {1.0, 1.0 + 0.9e-6, 1.0 + 1.8e-6, 1.0 + 2.9e-6, 2.0};
  Eigen::VectorXd omega_squared(5);
  for (int i = 0; i < 5; ++i) omega_squared(i) = f[i] * f[i];
  Eigen::VectorXi expected(5);
  expected << 1, 1, 1, 2, 3;
  CHECK(find_clusters(omega_squared) == expected);
  const ModeRange range = find_cluster_of(expected, 1);
  CHECK(range.begin == 0);
  CHECK(range.end == 3);
}

TEST_CASE("a cluster at the end of the modes wanted is followed to its last member") {
  Eigen::VectorXd omega_squared(40);
  for (int i = 0; i < 40; ++i) omega_squared(i) = i < 3 ? 1.0 + i : (i < 24 ? 10.0 : 20.0 + i);
  const ModalProblem problem = make_diagonal_problem(omega_squared);
  for (const EigenMethod method : {EigenMethod::kDense, EigenMethod::kSparse}) {
    const ClampedModes modes = calc_clamped_modes(problem, 5, {.method = method, .seed = 3});
    CHECK(modes.pairs.omega_squared.size() == 24);
    CHECK(modes.num_below == 24);
  }
}

TEST_CASE("a mode apart from its neighbour by hardly more than a cluster's gap is proved alone") {
  Eigen::VectorXd omega_squared = Eigen::VectorXd::LinSpaced(30, 1.0, 30.0);
  omega_squared(1) = std::pow(1.0 + 1.3e-6, 2);
  const ClampedModes modes =
      calc_clamped_modes(make_diagonal_problem(omega_squared), 1, {.method = EigenMethod::kDense});
  CHECK(modes.pairs.omega_squared.size() == 1);
  CHECK(modes.num_below == 1);
}

TEST_CASE("all modes of a frame can be computed") {
  const ModalProblem problem = make_cantilever(4);
  const ClampedModes modes = calc_clamped_modes(problem, 12);
  CHECK(modes.pairs.omega_squared.size() == 12);
  CHECK(modes.proof_hz == 0.0);
}

TEST_CASE("arguments out of range are the caller's mistake") {
  const ModalProblem problem = make_cantilever(4);
  CHECK_THAT(message_of<std::invalid_argument>([&] { calc_clamped_modes(problem, 0); }),
             Contains("expected 1 … 12"));
  CHECK_THAT(message_of<std::invalid_argument>([&] { calc_clamped_modes(problem, 13); }), Contains("is 13"));
  CHECK_THAT(message_of<std::invalid_argument>([&] { solve_sparse(problem, 12, 1); }),
             Contains("expected 1 … 11"));
}

TEST_CASE("a singular stiffness is a numerical error of both solvers") {
  const ModalProblem problem = make_diagonal_problem(Eigen::Vector4d(0.0, 1.0, 2.0, 3.0));
  CHECK_THAT(message_of<NumericalError>([&] { solve_dense(problem.stiffness, problem.mass); }),
             Contains("stiffness matrix is not positive definite"));
  CHECK_THAT(message_of<NumericalError>([&] { solve_sparse(problem, 2, 1); }),
             Contains("stiffness matrix is not positive definite"));
}

TEST_CASE("the dense solution is refused for frames too large for it") {
  const ModalProblem problem = make_diagonal_problem(Eigen::VectorXd::LinSpaced(kMaxDenseSize + 1, 1.0, 2.0));
  CHECK_THAT(
      message_of<NumericalError>([&] { calc_clamped_modes(problem, 2, {.method = EigenMethod::kDense}); }),
      Contains("up to 3000 freedoms, the frame has 3001"));
}

TEST_CASE("the rounding estimate follows the fourth power of the number of elements") {
  const auto estimate = [](int num_elements) {
    const ModalProblem problem = make_cantilever(num_elements);
    const EigenPairs pairs = solve_sparse(problem, 2, 1);
    return estimate_rounding_error(problem.stiffness, pairs.vectors.col(0), pairs.omega_squared(0));
  };
  const double coarse = estimate(100), fine = estimate(400);
  // Stiffness entries grow with N³ in N elements of 1/N of the mode each: N⁴ summed, N^3.5 as a root of a
  // sum.
  CHECK(std::log2(fine / coarse) / 2.0 == Approx(3.5).margin(0.15));
}

// Where it accepts designs it covers the error of every length. Errors of finer meshes scatter from one
// length and one order of elimination to the next about a third of the estimate; of 78 lengths from 1680 to
// 3000 elements and two orders the largest was 2.07 times it.
TEST_CASE("the rounding estimate covers the error that rounding really makes") {
  const fem::BeamProperties section = testing::make_section();
  const double exact =
      std::pow(1.8751040687119611, 4) * section.bending_rigidity / section.mass_per_length / 81.0;
  double sum_of_logarithms = 0.0;
  int num_refused = 0;
  for (const int num_elements :
       {300, 350, 400, 450, 500, 550, 600, 650, 700, 800, 900, 1000, 1750, 2000, 2250, 2500, 2750, 3000}) {
    const ModalProblem problem = make_cantilever(num_elements);
    const EigenPairs pairs = solve_sparse(problem, 2, 1);
    const double estimate =
        estimate_rounding_error(problem.stiffness, pairs.vectors.col(0), pairs.omega_squared(0));
    const double share = std::abs(pairs.omega_squared(0) / exact - 1.0) / estimate;
    CAPTURE(num_elements, estimate);
    if (estimate <= kMaxRoundingError) {
      CHECK(share < 1.0);
    } else {
      CHECK(share < 2.1);
      sum_of_logarithms += std::log(share);
      ++num_refused;
    }
  }
  REQUIRE(num_refused >= 6);
  CHECK(std::exp(sum_of_logarithms / num_refused) < 0.8);
}

}  // namespace
}  // namespace sprung::reduce
