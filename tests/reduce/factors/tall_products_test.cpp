#include "reduce/factors/tall_products.h"

#include <vector>

#include "tests/catch.h"

namespace sprung::reduce {
namespace {

// Few rows and many, and numbers of rows and columns that no vector's length divides. Expected: Eigen's
// products.
TEST_CASE("products of tall matrices are those that Eigen gives") {
  for (const Eigen::Index n : {1, 131, 5001, 5131}) {
    for (const Eigen::Index a : {0, 1, 2, 5, 12}) {
      for (const Eigen::Index b : {0, 1, 4, 7, 9}) {
        const Eigen::MatrixXd room = Eigen::MatrixXd::Random(n + 2, a), B = Eigen::MatrixXd::Random(n, b);
        const auto A = room.middleRows(1, n);  // columns that do not follow each other directly
        const Eigen::MatrixXd C = Eigen::MatrixXd::Random(a, b);
        CHECK((multiply_transposed(A, B) - A.transpose() * B).norm() <= 1e-13 * static_cast<double>(n));
        Eigen::MatrixXd Y = B;
        add_combinations(A, C, Y);
        CHECK((Y - B - A * C).norm() <= 1e-13 * static_cast<double>(n));
      }
    }
  }
}

TEST_CASE("products with a sparse matrix are those that Eigen gives, symmetric or not") {
  for (const int n : {23, 5003}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
      for (const int j : {i, (7 * i + 3) % n, (11 * i + 5) % n})
        entries.emplace_back(i, j, 1.0 + 0.01 * ((i + j) % 97));
    }
    Eigen::SparseMatrix<double> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    for (const Eigen::Index k : {0, 1, 3, 8, 19}) {
      const Eigen::MatrixXd X = Eigen::MatrixXd::Random(n, k);
      CHECK((multiply_transposed(A, X) - A.transpose() * X).norm() <= 1e-13 * n);
      CHECK((project(A, X) - X.transpose() * (A * X)).norm() <= 1e-12 * n);
    }
  }
}

}  // namespace
}  // namespace sprung::reduce
