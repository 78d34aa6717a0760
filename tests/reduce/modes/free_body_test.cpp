#include "reduce/modes/free_body.h"

#include <cmath>
#include <numbers>

#include "fem/assembly.h"
#include "reduce/modes/eigenvalue_count.h"
#include "reduce/modes/held_node.h"
#include "reduce/modes/modes_below.h"
#include "tests/catch.h"
#include "tests/reduce/free_body_truth.h"
#include "tests/reduce/test_bodies.h"

namespace sprung::reduce {
namespace {

struct FreeBody {
  RigidMotions rigid;
  ModalProblem problem;
};

FreeBody make_free_body(const fem::BeamModel& model, int reference_node) {
  const fem::AssembledMatrices matrices = fem::assemble(model);
  const Eigen::Matrix2Xd positions =
      model.mesh.node_positions.colwise() - model.mesh.node_positions.col(reference_node).eval();
  FreeBody body{.rigid = calc_rigid_motions(positions, matrices.mass, reference_node), .problem = {}};
  body.problem = {.stiffness = remove_node(matrices.stiffness, reference_node),
                  .mass = remove_node(matrices.mass, reference_node),
                  .rigid_share = calc_rigid_share(body.rigid)};
  return body;
}

double largest_relative_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a.cwiseQuotient(b).array() - 1.0).abs().maxCoeff();
}

// The frequencies of the free finite element model, all its freedoms solved densely, are the expected ones.
TEST_CASE("the free problem has the frequencies of the free body, whichever node is the reference") {
  const fem::BeamModel model = testing::make_random_frame(3);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(model).calc_frequencies().head(12);
  for (const int reference_node : {0, 4, 11}) {
    const FreeBody body = make_free_body(model, reference_node);
    for (const EigenMethod method : {EigenMethod::kDense, EigenMethod::kSparse}) {
      const ClampedModes modes = calc_clamped_modes(body.problem, 12, {.method = method});
      const Eigen::VectorXd found = modes.pairs.omega_squared.head(12).cwiseSqrt() / (2.0 * std::numbers::pi);
      CHECK(largest_relative_difference(found, expected) < 1e-9);
    }
  }
}

TEST_CASE(
    "moved back to the mean axes, free modes have neither momentum nor angular momentum, and unit mass") {
  const fem::BeamModel model = testing::make_random_frame(5);
  const FreeBody body = make_free_body(model, 2);
  const ClampedModes modes = calc_clamped_modes(body.problem, 8);
  const Eigen::MatrixXd V = remove_momentum(body.rigid, insert_node(modes.pairs.vectors, 2));
  const testing::FreeBodyTruth truth(model);
  const Eigen::Index n = V.cols();
  const double scale = std::sqrt(body.rigid.mass.diagonal().maxCoeff());
  CHECK((body.rigid.momenta.transpose() * V).cwiseAbs().maxCoeff() < 1e-10 * scale);
  CHECK((V.transpose() * truth.mass() * V - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() < 1e-10);
}

// 3 + k entries of D are negative for k elastic modes below σ; expected k by the dense truth.
TEST_CASE("the count of a free body's modes is that of its elastic ones") {
  for (const std::uint64_t seed : {1, 2, 7}) {
    const fem::BeamModel model = testing::make_random_frame(seed);
    const FreeBody body = make_free_body(model, 1);
    const Eigen::VectorXd all = testing::FreeBodyTruth(model).omega_squared();
    for (Eigen::Index k = 0; k < 10; ++k) {
      const double between = k == 0 ? 0.5 * all(3) : 0.5 * (all(2 + k) + all(3 + k));
      CHECK(count_modes_below(body.problem, between) == static_cast<int>(k));
    }
  }
}

TEST_CASE("the modes below a frequency are all that there are, and the next one is known") {
  const fem::BeamModel model = testing::make_random_frame(9);
  const FreeBody body = make_free_body(model, 0);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(model).calc_frequencies();
  const ModesBelow none = calc_modes_below(body.problem, 0.9 * expected(0));
  CHECK(none.cluster.size() == 0);
  CHECK(std::sqrt(none.next_omega_squared) == Approx(2.0 * std::numbers::pi * expected(0)).epsilon(1e-9));
  const ModesBelow five = calc_modes_below(body.problem, 0.5 * (expected(4) + expected(5)));
  CHECK(five.cluster.size() == 5);
  CHECK(five.num_missing == 0);
  CHECK(std::sqrt(five.next_omega_squared) == Approx(2.0 * std::numbers::pi * expected(5)).epsilon(1e-9));
  const ModesBelow all = calc_modes_below(body.problem, 2.0 * expected(expected.size() - 1));
  CHECK(all.cluster.size() == body.problem.size());
  CHECK(std::isinf(all.next_omega_squared));
}

// A star of four equal arms has free modes in pairs; a frequency inside the pair's rounding takes both.
TEST_CASE("a cluster at the frequency is taken whole") {
  const fem::BeamModel model = testing::make_star(4, 0.3);
  const FreeBody body = make_free_body(model, 0);
  const Eigen::VectorXd expected = testing::FreeBodyTruth(model).calc_frequencies();
  Eigen::Index first = 0;
  while (expected(first + 1) > expected(first) * (1.0 + 1e-7)) ++first;
  const ModesBelow modes = calc_modes_below(body.problem, expected(first) * (1.0 + 1e-12));
  Eigen::Index end = first + 2;
  while (expected(end) < expected(first) * (1.0 + 1e-7)) ++end;
  CHECK((modes.cluster.size() == first || modes.cluster.size() == end));
  CHECK(modes.next_omega_squared > 0.0);
}

}  // namespace
}  // namespace sprung::reduce
