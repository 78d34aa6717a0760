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
template <class Values, int kA, int kB>
SPRUNG_INLINED void add_inner(const Columns& A, const Columns& B, Index num_rows, double* result,
                              Index height) {
  constexpr Index kRows = sizeof(Values) / sizeof(double);
  Values sums[kA][kB] = {};
  Index row = 0;
  for (; row + kRows <= num_rows; row += kRows) {
    Values b[kB];
    for (int j = 0; j < kB; ++j) b[j] = load<Values>(B.at(row, j));
    for (int i = 0; i < kA; ++i) {
      const auto a = load<Values>(A.at(row, i));
      for (int j = 0; j < kB; ++j) sums[i][j] += a * b[j];
    }
  }
  for (int i = 0; i < kA; ++i) {
    for (int j = 0; j < kB; ++j) {
      double sum = 0.0;
      for (Index lane = 0; lane < kRows; ++lane) sum += sums[i][j][lane];
      for (Index rest = row; rest < num_rows; ++rest) sum += *A.at(rest, i) * *B.at(rest, j);
      result[i + j * height] += sum;
    }
  }
}

template <class Values, int kA, int kB>
SPRUNG_INLINED void add_inner_of(const Columns& A, Index num_a, const Columns& B, Index num_rows,
                                 double* result) {
  Index i = 0;
  for (; i + kA <= num_a; i += kA)
    add_inner<Values, kA, kB>({A.at(0, i), A.stride}, B, num_rows, result + i, num_a);
  for (; i < num_a; ++i) add_inner<Values, 1, kB>({A.at(0, i), A.stride}, B, num_rows, result + i, num_a);
}

// kA columns of A and four of B at a time: as many sums as the processor has registers for.
template <class Values, int kA>
SPRUNG_INLINED void add_all_inner(const Columns& A, Index num_a, const Columns& B, Index num_b,
                                  Index num_rows, double* result) {
  Index j = 0;
  for (; j + 4 <= num_b; j += 4)
    add_inner_of<Values, kA, 4>(A, num_a, {B.at(0, j), B.stride}, num_rows, result + j * num_a);
  for (; j < num_b; ++j)
    add_inner_of<Values, kA, 1>(A, num_a, {B.at(0, j), B.stride}, num_rows, result + j * num_a);
}

SPRUNG_VECTORISED
void add_inner_by_four(const Columns& A, Index num_a, const Columns& B, Index num_b, Index num_rows,
                       double* result) {
  add_all_inner<FourDoubles, 2>(A, num_a, B, num_b, num_rows, result);
}
SPRUNG_VECTORISED
void add_inner_by_eight(const Columns& A, Index num_a, const Columns& B, Index num_b, Index num_rows,
                        double* result) {
  add_all_inner<EightDoubles, 4>(A, num_a, B, num_b, num_rows, result);
}

// kVectors vectors of rows of kC columns Y += A C: they stay in registers while the columns of A pass.
template <int kVectors, int kC>
SPRUNG_INLINED void add_tile(const Columns& A, Index num_a, const Columns& C, double* Y, Index stride) {
  constexpr Index kRows = 8;
  EightDoubles sums[kVectors][kC];
  for (int v = 0; v < kVectors; ++v) {
    for (int c = 0; c < kC; ++c) sums[v][c] = load<EightDoubles>(Y + kRows * v + c * stride);
  }
  for (Index i = 0; i < num_a; ++i) {
    EightDoubles a[kVectors];
    for (int v = 0; v < kVectors; ++v) a[v] = load<EightDoubles>(A.at(kRows * v, i));
    for (int c = 0; c < kC; ++c) {
      const double coefficient = *C.at(i, c);
      for (int v = 0; v < kVectors; ++v) sums[v][c] += a[v] * coefficient;
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    for (int c = 0; c < kC; ++c) store(sums[v][c], Y + kRows * v + c * stride);
  }
}

// kC columns of Y.
template <int kVectors, int kC>
SPRUNG_INLINED void add_to_columns(const Columns& A, Index num_a, const Columns& C, Index num_rows, double* Y,
                                   Index stride) {
  constexpr Index kRows = 8;
  Index row = 0;
  for (; row + kVectors * kRows <= num_rows; row += kVectors * kRows)
    add_tile<kVectors, kC>({A.at(row, 0), A.stride}, num_a, C, Y + row, stride);
  for (; row + kRows <= num_rows; row += kRows)
    add_tile<1, kC>({A.at(row, 0), A.stride}, num_a, C, Y + row, stride);
  for (; row < num_rows; ++row) {
    for (Index i = 0; i < num_a; ++i) {
      for (int c = 0; c < kC; ++c) Y[row + c * stride] += *A.at(row, i) * *C.at(i, c);
    }
  }
}

SPRUNG_VECTORISED
void add_column_combinations(const Columns& A, Index num_a, const Columns& C, Index num_c, Index num_rows,
                             double* Y, Index stride) {
  Index c = 0;
  for (; c + 4 <= num_c; c += 4)
    add_to_columns<1, 4>(A, num_a, {C.at(0, c), C.stride}, num_rows, Y + c * stride, stride);
  for (; c < num_c; ++c)
    add_to_columns<4, 1>(A, num_a, {C.at(0, c), C.stride}, num_rows, Y + c * stride, stride);
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

bool is_tall(Index num_rows) {
  return num_rows >= kTall;
}

MatrixXd multiply_transposed(const TallMatrix& A, const TallMatrix& B) {
  if (!is_tall(A.rows())) return A.transpose() * B;
  MatrixXd result = MatrixXd::Zero(A.cols(), B.cols());
  const auto add_inner_products = has_many_registers() ? add_inner_by_eight : add_inner_by_four;
  for (Index row = 0; row < A.rows(); row += kRowsAtOnce) {
    add_inner_products({A.data() + row, A.outerStride()}, A.cols(), {B.data() + row, B.outerStride()},
                       B.cols(), std::min(kRowsAtOnce, A.rows() - row), result.data());
  }
  return result;
}

void add_combinations(const TallMatrix& A, const TallMatrix& C, Eigen::Ref<MatrixXd> Y) {
  add_combinations(A, C, Y, is_tall(A.rows()));
}

void add_combinations(const TallMatrix& A, const TallMatrix& C, Eigen::Ref<MatrixXd> Y, bool vectorised) {
  if (!vectorised) {
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
  if (X.cols() == 1 || !is_tall(A.rows())) return A.transpose() * X;
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
