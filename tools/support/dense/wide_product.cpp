#include "tools/support/dense/wide_product.h"

#include <algorithm>
#include <cstring>

namespace sprung::support {

namespace {

using Eigen::Index;

// As many doubles as an instruction takes.
using One [[gnu::vector_size(8)]] = double;
using Two [[gnu::vector_size(16)]] = double;
using Four [[gnu::vector_size(32)]] = double;

constexpr int kMostSums = 8;          // vectors of rows at a time: enough to hide the delay of an addition
constexpr Index kSmallProduct = 24;   // rows up to which products are rounded before they are added
constexpr Index kLargeProduct = 128;  // rows above which whole columns are read

// All functions below are inlined and so use the instructions that the calling function is compiled for.

// Some vectors of rows of y, whose sums stay in registers. The last one may overlap the one before.
// @param first, last  the first row of all, and of the last vector
template <typename Doubles, int count>
[[gnu::always_inline]] inline void multiply_rows(const Eigen::MatrixXd& A, Index first, Index last,
                                                 const double* x, double* y) {
  constexpr Index kWidth = sizeof(Doubles) / sizeof(double);
  const auto row_of = [&](int i) { return i + 1 < count ? first + i * kWidth : last; };
  Doubles sums[count] = {};
  const double* column = A.data();
  for (Index k = 0; k < A.cols(); ++k, column += A.rows()) {
#pragma GCC unroll 8
    for (int i = 0; i < count; ++i) {
      Doubles entries;
      std::memcpy(&entries, column + row_of(i), sizeof entries);
      sums[i] += entries * x[k];
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < count; ++i) std::memcpy(y + row_of(i), &sums[i], sizeof sums[i]);
}

// The same for a number of vectors that is known when the program runs, from 1 to `most`.
template <typename Doubles, int most>
[[gnu::always_inline]] inline void multiply_some_rows(Index count, const Eigen::MatrixXd& A, Index first,
                                                      Index last, const double* x, double* y) {
  if constexpr (most == 1) {
    multiply_rows<Doubles, 1>(A, first, last, x, y);
  } else if (count == most) {
    multiply_rows<Doubles, most>(A, first, last, x, y);
  } else {
    multiply_some_rows<Doubles, most - 1>(count, A, first, last, x, y);
  }
}

// At least as many rows as a vector takes.
template <typename Doubles>
[[gnu::always_inline]] inline void multiply_all_rows(const Eigen::MatrixXd& A, const double* x, double* y) {
  constexpr Index kWidth = sizeof(Doubles) / sizeof(double);
  for (Index first = 0; first < A.rows(); first += kMostSums * kWidth) {
    const Index count = std::min<Index>((A.rows() - first + kWidth - 1) / kWidth, kMostSums);
    const Index last = std::min(first + (count - 1) * kWidth, A.rows() - kWidth);
    multiply_some_rows<Doubles, kMostSums>(count, A, first, last, x, y);
  }
}

// Four columns at a time, so that y is read and written once for each four.
[[gnu::always_inline]] inline void multiply_columns(const Eigen::MatrixXd& A, const double* __restrict x,
                                                    double* __restrict y) {
  const Index rows = A.rows(), cols = A.cols();
  std::fill(y, y + rows, 0.0);
  const double* a = A.data();
  Index k = 0;
  for (; k + 4 <= cols; k += 4, a += 4 * rows) {
    const double *b = a + rows, *c = b + rows, *d = c + rows;
    const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
    for (Index i = 0; i < rows; ++i) y[i] = (((y[i] + a[i] * x0) + b[i] * x1) + c[i] * x2) + d[i] * x3;
  }
  for (; k < cols; ++k, a += rows) {
    for (Index i = 0; i < rows; ++i) y[i] += a[i] * x[k];
  }
}

// @tparam Widest  the vector that the calling function's instructions take
template <typename Widest>
[[gnu::always_inline]] inline void multiply_small(const Eigen::MatrixXd& A, const double* x, double* y) {
  if (A.rows() >= static_cast<Index>(sizeof(Widest) / sizeof(double))) {
    multiply_all_rows<Widest>(A, x, y);
  } else if (A.rows() >= 2) {
    multiply_all_rows<Two>(A, x, y);
  } else {
    multiply_all_rows<One>(A, x, y);
  }
}

template <typename Widest>
[[gnu::always_inline]] inline void multiply_large(const Eigen::MatrixXd& A, const double* x, double* y) {
  if (A.rows() > kLargeProduct) {
    multiply_columns(A, x, y);
  } else {
    multiply_all_rows<Widest>(A, x, y);
  }
}

struct Products {
  void (*small)(const Eigen::MatrixXd& A, const double* x, double* y);
  void (*large)(const Eigen::MatrixXd& A, const double* x, double* y);
};

void multiply_small_by_two(const Eigen::MatrixXd& A, const double* x, double* y) {
  multiply_small<Two>(A, x, y);
}

void multiply_large_by_two(const Eigen::MatrixXd& A, const double* x, double* y) {
  multiply_large<Two>(A, x, y);
}

#if defined(__x86_64__)
// Products are rounded before they are added: with FMA, runs with 36 modes took up to a tenth more steps.
[[gnu::target("avx2")]] void multiply_small_by_four(const Eigen::MatrixXd& A, const double* x, double* y) {
  multiply_small<Four>(A, x, y);
}

[[gnu::target("avx2,fma")]] void multiply_large_by_four(const Eigen::MatrixXd& A, const double* x,
                                                        double* y) {
  multiply_large<Four>(A, x, y);
}

// Eight at a time were no quicker over a whole run: the clock of the processor is lower then.
Products choose_products() {
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return {multiply_small_by_four, multiply_large_by_four};
  return {multiply_small_by_two, multiply_large_by_two};
}
#else
Products choose_products() {
  return {multiply_small_by_two, multiply_large_by_two};
}
#endif

}  // namespace

void multiply(const Eigen::MatrixXd& A, const double* x, double* y) {
  static const Products products = choose_products();
  (A.rows() <= kSmallProduct ? products.small : products.large)(A, x, y);
}

}  // namespace sprung::support
