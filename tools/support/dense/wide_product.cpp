#include "tools/support/dense/wide_product.h"

#include <algorithm>

namespace sprung::support {

namespace {

constexpr Eigen::Index kSmallProduct = 24;  // rows up to which sums stay in registers

template <int num_rows>
void multiply_rows(const Eigen::MatrixXd& A, Eigen::Index first, const double* x, double* y) {
  using Rows = Eigen::Matrix<double, num_rows, 1>;
  const double* entry = A.data() + first;
  Rows sum = Rows::Zero();
  for (Eigen::Index k = 0; k < A.cols(); ++k, entry += A.rows()) sum += x[k] * Eigen::Map<const Rows>(entry);
  Eigen::Map<Rows>(y + first) = sum;
}

// Four columns at a time, so that y is read and written once for each four. The compiler makes vector
// instructions of the loops: those that the calling function is compiled for.
[[gnu::always_inline]] inline void multiply_columns(const Eigen::MatrixXd& A, const double* __restrict x,
                                                    double* __restrict y) {
  const Eigen::Index rows = A.rows(), cols = A.cols();
  std::fill(y, y + rows, 0.0);
  const double* a = A.data();
  Eigen::Index k = 0;
  for (; k + 4 <= cols; k += 4, a += 4 * rows) {
    const double *b = a + rows, *c = b + rows, *d = c + rows;
    const double x0 = x[k], x1 = x[k + 1], x2 = x[k + 2], x3 = x[k + 3];
    for (Eigen::Index i = 0; i < rows; ++i) y[i] = (((y[i] + a[i] * x0) + b[i] * x1) + c[i] * x2) + d[i] * x3;
  }
  for (; k < cols; ++k, a += rows) {
    for (Eigen::Index i = 0; i < rows; ++i) y[i] += a[i] * x[k];
  }
}

void multiply_narrow(const Eigen::MatrixXd& A, const double* x, double* y) {
  multiply_columns(A, x, y);
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void multiply_wide(const Eigen::MatrixXd& A, const double* x, double* y) {
  multiply_columns(A, x, y);
}

auto choose_product() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? multiply_wide : multiply_narrow;
}
#else
auto choose_product() {
  return multiply_narrow;
}
#endif

}  // namespace

// For small matrices the overhead of the loops exceeds the product: four rows at a time, in registers.
void multiply(const Eigen::MatrixXd& A, const double* x, double* y) {
  static const auto multiply_large = choose_product();
  const Eigen::Index size = A.rows();
  if (size > kSmallProduct) {
    multiply_large(A, x, y);
    return;
  }
  Eigen::Index first = 0;
  for (; first + 4 <= size; first += 4) multiply_rows<4>(A, first, x, y);
  if (first + 2 <= size) {
    multiply_rows<2>(A, first, x, y);
    first += 2;
  }
  if (first < size) multiply_rows<1>(A, first, x, y);
}

}  // namespace sprung::support
