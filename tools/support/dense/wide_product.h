#pragma once

#include <Eigen/Core>

namespace sprung::support {

/// y = A x, four numbers at a time where the processor has the instructions for it (AVX2 with FMA). Results
/// differ by rounding between processors with and without them.
///
/// @param A  m×n   @param x  n   @param[out] y  m, other memory than x
/// Checked by tests/tools/support/wide_product_test.cpp
void multiply(const Eigen::MatrixXd& A, const double* x, double* y);

}  // namespace sprung::support
