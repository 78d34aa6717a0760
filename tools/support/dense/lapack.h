#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <complex>
#include <limits>

#define LAPACK_COMPLEX_CUSTOM
#define lapack_complex_float std::complex<float>
#define lapack_complex_double std::complex<double>
#include <lapacke.h>

/// Sizes of Eigen's matrices as LAPACK takes them, and what stands for a result that it does not find.
namespace sprung::support::lapack {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class Matrix>
int rows(const Matrix& A) {
  return static_cast<int>(A.rows());
}
template <class Matrix>
int cols(const Matrix& A) {
  return static_cast<int>(A.cols());
}
/// From one column to the next.
template <class Matrix>
int stride(const Matrix& A) {
  return std::max(1, rows(A));
}

}  // namespace sprung::support::lapack
