// The sparse factors against Eigen's dense ones, on random patterns, and their cost on chains.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "dynamics/linear_algebra/block_cholesky.h"
#include "dynamics/linear_algebra/column_pivoting.h"
#include "dynamics/linear_algebra/sparse_lu.h"
#include "dynamics/system/partitioned_equations.h"
#include "tests/catch.h"
#include "tests/dynamics/chains.h"
#include "tests/dynamics/random_numbers.h"

using namespace sprung;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A permuted diagonal, which makes it regular, with scattered entries around it.
std::vector<dynamics::MatrixPosition> scattered_pattern(int size) {
  std::vector<dynamics::MatrixPosition> pattern;
  for (int i = 0; i < size; ++i) pattern.push_back({i, (7 * i + 3) % size});
  for (int i = 0; i < 2 * size; ++i) pattern.push_back({(5 * i + 1) % size, (11 * i * i + i) % size});
  return pattern;
}

MatrixXd make_dense(int size, const std::vector<dynamics::MatrixPosition>& pattern, const VectorXd& values) {
  MatrixXd matrix = MatrixXd::Zero(size, size);
  for (std::size_t k = 0; k < pattern.size(); ++k) {
    matrix(pattern[k].row, pattern[k].column) += values[static_cast<Eigen::Index>(k)];
  }
  return matrix;
}

}  // namespace

TEST_CASE("Sparse LU solves, transposed too, with new values, and has the determinant with its sign",
          "[system]") {
  test::RandomNumbers random(5);
  for (const int size : {1, 2, 5, 20}) {
    const std::vector<dynamics::MatrixPosition> pattern = scattered_pattern(size);
    dynamics::SparseLu lu(size, pattern);
    for (int i = 0; i < 20; ++i) {
      VectorXd values = random.vector(static_cast<int>(pattern.size()), 1.0);
      for (int k = 0; k < size; ++k) values[k] += values[k] < 0.0 ? -3.0 : 3.0;
      const MatrixXd dense = make_dense(size, pattern, values);
      lu.factorise({values.data(), static_cast<std::size_t>(values.size())});
      const VectorXd r = random.vector(size, 1.0);
      VectorXd x = r;
      lu.solve(x.data());
      CHECK((dense * x - r).norm() < 1e-12 * (1.0 + x.norm()));
      x = r;
      lu.solve_transposed(x.data());
      CHECK((dense.transpose() * x - r).norm() < 1e-12 * (1.0 + x.norm()));
      CHECK(lu.determinant() == Approx(dense.determinant()).epsilon(1e-10));
    }
  }
}

TEST_CASE("Sparse LU chooses other pivots where the first have become small", "[system]") {
  dynamics::SparseLu lu(2, {{0, 0}, {0, 1}, {1, 0}, {1, 1}});
  lu.factorise(std::vector<double>{1.0, 0.3, 0.2, 1.0});
  lu.factorise(std::vector<double>{1e-17, 1.0, 1.0, 2.0});
  std::vector<double> x{3.0, 8.0};  // of (2, 3)
  lu.solve(x.data());
  CHECK(x[0] == Approx(2.0).epsilon(1e-14));
  CHECK(x[1] == Approx(3.0).epsilon(1e-14));
  CHECK(lu.determinant() == Approx(-1.0));
}

TEST_CASE("Block Cholesky solves, and tells an indefinite matrix", "[system]") {
  constexpr int kNumNodes = 24;
  std::vector<std::pair<int, int>> couplings;
  for (const auto& [i, j] : scattered_pattern(kNumNodes)) couplings.emplace_back(i, j);
  dynamics::BlockCholesky factor(kNumNodes, couplings);
  test::RandomNumbers random(8);
  // In the order of elimination, in which the factors have it.
  MatrixXd dense = 8.0 * MatrixXd::Identity(2 * kNumNodes, 2 * kNumNodes);
  const auto block = [&](int node, int other) {
    return dense.block<2, 2>(2 * factor.step(node), 2 * factor.step(other));
  };
  const auto load = [&] {
    const auto at = [&](int i, int j) -> Eigen::Matrix2d& {
      return factor.blocks()[static_cast<std::size_t>(factor.place(i, j))];
    };
    std::fill(factor.blocks().begin(), factor.blocks().end(), Eigen::Matrix2d::Zero());
    for (int i = 0; i < kNumNodes; ++i) at(i, i) = block(i, i);
    for (const auto& [i, j] : couplings) {
      if (factor.step(i) > factor.step(j)) at(i, j) = block(i, j);
      if (factor.step(i) < factor.step(j)) at(i, j) = block(j, i);
    }
  };
  for (const auto& [i, j] : couplings) {
    for (int k = 0; k < 4; ++k) block(i, j)(k / 2, k % 2) = random.size_up_to(1.0);
    if (i == j) {
      block(i, i)(0, 0) = block(i, i)(1, 1) = 8.0;
      block(i, i)(0, 1) = block(i, i)(1, 0);
    } else {
      block(j, i) = block(i, j).transpose();
    }
  }
  load();
  REQUIRE(factor.factorise());
  const VectorXd r = random.vector(2 * kNumNodes, 1.0);
  std::vector<Eigen::Vector2d> nodes(kNumNodes);
  Eigen::Map<VectorXd> x(nodes[0].data(), 2 * kNumNodes);
  x = r;
  factor.solve(nodes.data());
  CHECK((dense * x - r).norm() < 1e-13 * x.norm() * dense.norm());
  for (const int row : {0, 1}) {
    const double before = block(5, 5)(row, row);
    block(5, 5)(row, row) = -1.0;
    load();
    CHECK_FALSE(factor.factorise());
    block(5, 5)(row, row) = before;
  }
}

TEST_CASE("Sparse pivoting takes the columns that dense QR takes", "[system]") {
  test::RandomNumbers random(31);
  for (int i = 0; i < 20; ++i) {
    MatrixXd dense = MatrixXd::Zero(9, 15);
    for (int k = 0; k < 45; ++k) dense((7 * k + i) % 9, (4 * k) % 15) = random.size_up_to(1.0);
    if (i % 4 == 0)
      dense.row(3) = dense.row(5) - 2.0 * dense.row(8);  // of lower rank: nothing is left for the last
    const dynamics::ColumnPivots found = dynamics::choose_columns(dense.sparseView());
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(dense);
    REQUIRE(found.columns.size() == 9);
    for (std::size_t k = 0; k < 9; ++k) {
      const auto place = static_cast<Eigen::Index>(k);
      const double norm = std::abs(qr.matrixQR()(place, place));
      CHECK(found.sizes[k] == Approx(norm).epsilon(1e-6).margin(1e-14));
      if (norm > 1e-12) CHECK(found.columns[k] == qr.colsPermutation().indices()[place]);
    }
  }
}

TEST_CASE("Of columns whose lengths differ by rounding only, the first is taken", "[system]") {
  // Columns 1 and 2 differ by 1e-11 of their length, less than what counts; after that, column 3 is longer
  // than column 0 by far more.
  const MatrixXd dense = (MatrixXd(2, 4) << 0.0, 3.0, 3.0 * (1.0 + 1e-11), 0.0,  //
                          1.0, 0.0, 0.0, 1.0 + 1e-6)
                             .finished();
  const dynamics::ColumnPivots found = dynamics::choose_columns(dense.sparseView());
  CHECK(found.columns == std::vector<int>{1, 3});
}

TEST_CASE("No columns are chosen from a matrix without rows", "[system]") {
  const dynamics::ColumnPivots found = dynamics::choose_columns(Eigen::SparseMatrix<double>(0, 4));
  CHECK(found.columns.empty());
  CHECK(found.sizes.empty());
}

TEST_CASE("From many rows regular columns are chosen, with moderate factors for the other columns",
          "[system]") {
  // Rows of four entries at random; sizes from 0.1 to 1, so that none is much less than its row's largest.
  constexpr int kNumRows = 170, kNumColumns = 260;
  test::RandomNumbers random(37);
  MatrixXd dense = MatrixXd::Zero(kNumRows, kNumColumns);
  for (int i = 0; i < kNumRows; ++i) {
    for (int k = 0; k < 4; ++k) {
      const int j = static_cast<int>(random.between(0.0, kNumColumns));
      dense(i, j) = random.between(0.1, 1.0) * (random.between(-1.0, 1.0) < 0.0 ? -1.0 : 1.0);
    }
  }
  const dynamics::ColumnPivots found = dynamics::choose_columns(dense.sparseView());
  REQUIRE(std::set<int>(found.columns.begin(), found.columns.end()).size() == kNumRows);
  const Eigen::FullPivLU<MatrixXd> taken(dense(Eigen::all, found.columns));
  REQUIRE(taken.isInvertible());
  // Dense QR, which takes the longest, leaves a largest factor of 1.4; pivots that are small in their rows,
  // 2000.
  CHECK(taken.solve(dense).cwiseAbs().maxCoeff() < 20.0);

  dense.row(3) = dense.row(5) - 2.0 * dense.row(8);  // of lower rank: nothing is left for the last
  const dynamics::ColumnPivots of_less = dynamics::choose_columns(dense.sparseView());
  CHECK(*std::min_element(of_less.sizes.begin(), of_less.sizes.end()) < 1e-12);
}

TEST_CASE("The factors of a chain have entries in proportion to its bodies, open and closed", "[system]") {
  // Operations follow from entries: no row of the factors grows with the chain.
  const auto entries = [](const test::Chain& chain) {
    dynamics::PartitionedEquations equations(chain.model);
    equations.choose_partition_at(0.0, chain.state.q);
    return static_cast<double>(equations.num_factor_entries());
  };
  CHECK(entries(test::make_open_chain(400)) <= 10.5 * entries(test::make_open_chain(40)));
  CHECK(entries(test::make_closed_chain(400)) <= 13.0 * entries(test::make_closed_chain(40)));
}
