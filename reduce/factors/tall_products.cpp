#include "reduce/factors/tall_products.h"

#include <algorithm>

#include "reduce/factors/vectorised.h"

namespace sprung::reduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kTall = 5000;       // rows from which on; with fewer, digits do not depend on the processor
constexpr Index kRowsAtOnce = 128;  // of which some forty columns stay in the cache
constexpr Index kTogether = 8;      // columns of a sparse product

// Where a matrix stands: its columns begin `stride` apart.
struct Columns {
  const double* begin;
  Index stride;
  const double* at(Index row, Index column) const { return begin + row + column * stride; }
};

// Products of kA columns with kB columns, added to `result`, a columns-major matrix with `height` rows.
template <int kA, int kB>
SPRUNG_INLINED void add_inner(const Columns& A, const Columns& B, Index num_rows, double* result,
                              Index height) {
  FourDoubles sums[kA][kB] = {};
  Index row = 0;
  for (; row + 4 <= num_rows; row += 4) {
    FourDoubles b[kB];
    for (int j = 0; j < kB; ++j) b[j] = load<FourDoubles>(B.at(row, j));
    for (int i = 0; i < kA; ++i) {
      const auto a = load<FourDoubles>(A.at(row, i));
      for (int j = 0; j < kB; ++j) sums[i][j] += a * b[j];
    }
  }
  for (int i = 0; i < kA; ++i) {
    for (int j = 0; j < kB; ++j) {
      double sum = (sums[i][j][0] + sums[i][j][1]) + (sums[i][j][2] + sums[i][j][3]);
      for (Index rest = row; rest < num_rows; ++rest) sum += *A.at(rest, i) * *B.at(rest, j);
      result[i + j * height] += sum;
    }
  }
}

template <int kB>
SPRUNG_INLINED void add_inner_of(const Columns& A, Index num_a, const Columns& B, Index num_rows,
                                 double* result) {
  Index i = 0;
  for (; i + 2 <= num_a; i += 2) add_inner<2, kB>({A.at(0, i), A.stride}, B, num_rows, result + i, num_a);
  if (i < num_a) add_inner<1, kB>({A.at(0, i), A.stride}, B, num_rows, result + i, num_a);
}

SPRUNG_VECTORISED
void add_inner_products(const Columns& A, Index num_a, const Columns& B, Index num_b, Index num_rows,
                        double* result) {
  Index j = 0;
  for (; j + 4 <= num_b; j += 4)
    add_inner_of<4>(A, num_a, {B.at(0, j), B.stride}, num_rows, result + j * num_a);
  for (; j < num_b; ++j) add_inner_of<1>(A, num_a, {B.at(0, j), B.stride}, num_rows, result + j * num_a);
}

// y += Σ kA columns, each times its coefficient.
template <int kA>
SPRUNG_INLINED void add_columns(const Columns& A, const double* coefficients, Index num_rows, double* y) {
  Index row = 0;
  for (; row + 4 <= num_rows; row += 4) {
    auto sum = load<FourDoubles>(y + row);
    for (int i = 0; i < kA; ++i) sum += load<FourDoubles>(A.at(row, i)) * coefficients[i];
    store(sum, y + row);
  }
  for (; row < num_rows; ++row) {
    for (int i = 0; i < kA; ++i) y[row] += *A.at(row, i) * coefficients[i];
  }
}

SPRUNG_VECTORISED
void add_column_combinations(const Columns& A, Index num_a, const Columns& C, Index num_c, Index num_rows,
                             double* Y, Index stride) {
  Index i = 0;
  for (; i + 4 <= num_a; i += 4) {
    for (Index j = 0; j < num_c; ++j)
      add_columns<4>({A.at(0, i), A.stride}, C.at(i, j), num_rows, Y + j * stride);
  }
  for (; i < num_a; ++i) {
    for (Index j = 0; j < num_c; ++j)
      add_columns<1>({A.at(0, i), A.stride}, C.at(i, j), num_rows, Y + j * stride);
  }
}

// Columns of a sparse matrix times kTogether columns, whose rows lie together.
// @param result  rows of kTogether values, one for each column of the sparse matrix
SPRUNG_VECTORISED
void multiply_columns(const int* starts, const int* rows, const double* values, Index num_columns,
                      const double* x, double* result) {
  for (Index column = 0; column < num_columns; ++column) {
    EightDoubles sum = {};
    for (int entry = starts[column]; entry < starts[column + 1]; ++entry)
      sum += values[entry] * load<EightDoubles>(x + kTogether * static_cast<Index>(rows[entry]));
    store(sum, result + kTogether * column);
  }
}

}  // namespace

MatrixXd multiply_transposed(const TallMatrix& A, const TallMatrix& B) {
  if (A.rows() < kTall) return A.transpose() * B;
  MatrixXd result = MatrixXd::Zero(A.cols(), B.cols());
  for (Index row = 0; row < A.rows(); row += kRowsAtOnce) {
    add_inner_products({A.data() + row, A.outerStride()}, A.cols(), {B.data() + row, B.outerStride()},
                       B.cols(), std::min(kRowsAtOnce, A.rows() - row), result.data());
  }
  return result;
}

void add_combinations(const TallMatrix& A, const TallMatrix& C, Eigen::Ref<MatrixXd> Y) {
  if (A.rows() < kTall) {
    Y.noalias() += A * C;
    return;
  }
  for (Index row = 0; row < A.rows(); row += kRowsAtOnce) {
    add_column_combinations({A.data() + row, A.outerStride()}, A.cols(), {C.data(), C.outerStride()},
                            C.cols(), std::min(kRowsAtOnce, A.rows() - row), Y.data() + row, Y.outerStride());
  }
}

MatrixXd multiply_transposed(const Eigen::SparseMatrix<double>& A, const TallMatrix& X) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, kTogether, Eigen::RowMajor>;
  if (X.cols() == 1 || A.rows() < kTall) return A.transpose() * X;
  MatrixXd result(A.cols(), X.cols());
  Rows x = Rows::Zero(A.rows(), kTogether), product(A.cols(), kTogether);
  for (Index begin = 0; begin < X.cols(); begin += kTogether) {
    const Index width = std::min(kTogether, X.cols() - begin);
    x.leftCols(width) = X.middleCols(begin, width);
    multiply_columns(A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), A.cols(), x.data(), product.data());
    result.middleCols(begin, width) = product.leftCols(width);
  }
  return result;
}

MatrixXd project(const Eigen::SparseMatrix<double>& A, const TallMatrix& V) {
  return multiply_transposed(multiply_transposed(A, V), V);
}

}  // namespace sprung::reduce
