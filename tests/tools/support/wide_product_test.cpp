#include "tools/support/dense/wide_product.h"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "tests/catch.h"

using namespace sprung;

TEST_CASE("A wide product is the product that Eigen gives, whatever the numbers of rows and columns",
          "[dense]") {
  // An error of rounding in each of n products and sums: n ε |A| |x| in each row.
  for (const Eigen::Index rows : {1, 2, 3, 4, 5, 7, 8, 23, 31, 32, 33, 41, 66, 114, 128, 129, 150}) {
    for (const Eigen::Index cols : {1, 5, 24, 26, 115}) {
      const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(rows, cols, [](Eigen::Index i, Eigen::Index k) {
        return std::sin(1.0 + 3.7 * static_cast<double>(i) + 0.9 * static_cast<double>(k * k));
      });
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(cols, -1.3, 2.1);
      Eigen::VectorXd y = Eigen::VectorXd::Constant(rows, std::numeric_limits<double>::quiet_NaN());
      support::multiply(A, x.data(), y.data());
      const Eigen::VectorXd allowed =
          static_cast<double>(cols) * std::numeric_limits<double>::epsilon() * (A.cwiseAbs() * x.cwiseAbs());
      CHECK(((y - A.lazyProduct(x)).cwiseAbs().array() <= 2.0 * allowed.array()).all());
    }
  }
}
