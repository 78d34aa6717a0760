#include "tools/support/dense/orthogonal_factors.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/support/dense/lapack.h"

namespace sprung::support {

namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon();

// Q of the first reflectors of QR factors.
// @param columns  m×k with the factors in its first columns; becomes the first k columns of Q
void make_orthogonal_columns(Eigen::MatrixXd& columns, const Eigen::VectorXd& reflectors) {
  const auto count = std::min(lapack::cols(columns), static_cast<int>(reflectors.size()));
  if (LAPACKE_dorgqr(LAPACK_COL_MAJOR, lapack::rows(columns), lapack::cols(columns), count, columns.data(),
                     lapack::stride(columns), reflectors.data()) != 0)
    columns.setConstant(lapack::kNone);
}

// @param vectors  LAPACK's choice: all ('A'), as many as singular values ('S') or none ('N')
struct SingularValueFactors {
  Eigen::VectorXd values;
  Eigen::MatrixXd U, V_transposed;
};
SingularValueFactors factorise(Eigen::MatrixXd A, char vectors) {
  const int m = lapack::rows(A), n = lapack::cols(A), least = std::min(m, n);
  SingularValueFactors factors{.values = Eigen::VectorXd(least), .U = {}, .V_transposed = {}};
  if (vectors != 'N') {
    factors.U.resize(m, vectors == 'A' ? m : least);
    factors.V_transposed.resize(vectors == 'A' ? n : least, n);
  }
  if (LAPACKE_dgesdd(LAPACK_COL_MAJOR, vectors, m, n, A.data(), lapack::stride(A), factors.values.data(),
                     factors.U.data(), lapack::stride(factors.U), factors.V_transposed.data(),
                     lapack::stride(factors.V_transposed)) != 0) {
    for (Eigen::MatrixXd* matrix : {&factors.U, &factors.V_transposed}) matrix->setConstant(lapack::kNone);
    factors.values.setConstant(lapack::kNone);
  }
  return factors;
}

}  // namespace

ColumnSpace find_column_space(const Eigen::MatrixXd& A, Eigen::Index num_columns) {
  Eigen::MatrixXd factors = A;
  std::vector<int> columns(static_cast<std::size_t>(A.cols()), 0);  // 0: may be moved
  Eigen::VectorXd reflectors(std::min(A.rows(), A.cols()));
  ColumnSpace space;
  if (LAPACKE_dgeqp3(LAPACK_COL_MAJOR, lapack::rows(A), lapack::cols(A), factors.data(), lapack::stride(A),
                     columns.data(), reflectors.data()) != 0) {
    space.basis = Eigen::MatrixXd::Constant(A.rows(), num_columns, lapack::kNone);
    return space;
  }
  const Eigen::ArrayXd pivots = factors.diagonal().array().abs();
  if (pivots.size() > 0)
    space.rank = (pivots > kRounding * static_cast<double>(pivots.size()) * pivots.maxCoeff()).count();
  space.basis = Eigen::MatrixXd::Zero(A.rows(), num_columns);
  const Eigen::Index shared = std::min(num_columns, A.cols());
  space.basis.leftCols(shared) = factors.leftCols(shared);
  make_orthogonal_columns(space.basis, reflectors);
  return space;
}

Eigen::MatrixXd make_rotation_onto(const Eigen::VectorXd& direction) {
  return find_column_space(direction, direction.size()).basis;
}

Eigen::MatrixXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b) {
  if (A.size() == 0) return Eigen::MatrixXd::Zero(A.cols(), b.cols());
  Eigen::MatrixXd overwritten = A, x = Eigen::MatrixXd::Zero(std::max(A.rows(), A.cols()), b.cols());
  x.topRows(b.rows()) = b;
  std::vector<int> columns(static_cast<std::size_t>(A.cols()), 0);
  const double smallest = kRounding * static_cast<double>(std::max(A.rows(), A.cols()));
  int rank = 0;
  if (LAPACKE_dgelsy(LAPACK_COL_MAJOR, lapack::rows(A), lapack::cols(A), lapack::cols(b), overwritten.data(),
                     lapack::stride(A), x.data(), lapack::stride(x), columns.data(), smallest, &rank) != 0)
    x.setConstant(lapack::kNone);
  return x.topRows(A.cols());
}

Eigen::VectorXd calc_singular_values(const Eigen::MatrixXd& A) {
  return factorise(A, 'N').values;
}

SingularPairs calc_left_singular_pairs(const Eigen::MatrixXd& A) {
  SingularValueFactors factors = factorise(A, 'A');
  return {std::move(factors.values), std::move(factors.U)};
}

SingularPairs calc_right_singular_pairs(const Eigen::MatrixXd& A) {
  SingularValueFactors factors = factorise(A, 'S');
  return {std::move(factors.values), factors.V_transposed.transpose()};
}

}  // namespace sprung::support
