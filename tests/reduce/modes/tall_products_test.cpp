#include "reduce/modes/tall_products.h"

#include "tests/catch.h"

namespace sprung::reduce {
namespace {

// More rows than are multiplied at once, and numbers of rows and columns that no vector's length divides.
// Expected: Eigen's products.
TEST_CASE("products of tall matrices are those that Eigen gives") {
  for (const Eigen::Index n : {1, 3, 131, 517}) {
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
  const Eigen::MatrixXd dense =
      Eigen::MatrixXd::Random(23, 23).unaryExpr([](double x) { return x > 0.4 ? x : 0.0; });
  const Eigen::SparseMatrix<double> A = dense.sparseView();
  for (const Eigen::Index k : {0, 1, 3, 8, 19}) {
    const Eigen::MatrixXd X = Eigen::MatrixXd::Random(23, k);
    CHECK((multiply_transposed(A, X) - dense.transpose() * X).norm() <= 1e-13);
    CHECK((project(A, X) - X.transpose() * dense * X).norm() <= 1e-12);
  }
}

}  // namespace
}  // namespace sprung::reduce
