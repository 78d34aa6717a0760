#include "dynamics/system/small_lu.h"

#include <cmath>
#include <utility>

namespace sprung::dynamics {

SmallLu::SmallLu(int size)
    : size_(size),
      lu_(static_cast<std::size_t>(size * size)),
      pivots_(static_cast<std::size_t>(size)) {}

// A zero pivot is left to give infinities, which the caller finds in its result.
void SmallLu::factorise() {
  const int n = size_;
  double* a = lu_.data();
  determinant_ = 1.0;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    }
    pivots_[static_cast<std::size_t>(k)] = pivot;
    if (pivot != k) {
      determinant_ = -determinant_;
      for (int j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
    }
    determinant_ *= a[k * n + k];
    const double inverse = 1.0 / a[k * n + k];
    for (int i = k + 1; i < n; ++i) {
      double& factor = a[i * n + k];
      if (factor == 0.0) continue;  // much of a Jacobian is
      factor *= inverse;
      for (int j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
    }
    a[k * n + k] = inverse;  // kept inverted: solving then divides nowhere
  }
}

void SmallLu::solve(double* x) const {
  const int n = size_;
  const double* a = lu_.data();
  for (int k = 0; k < n; ++k) {
    const int pivot = pivots_[static_cast<std::size_t>(k)];
    if (pivot != k) std::swap(x[k], x[pivot]);
  }
  for (int i = 1; i < n; ++i) {
    double sum = x[i];
    for (int j = 0; j < i; ++j) sum -= a[i * n + j] * x[j];
    x[i] = sum;
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int j = i + 1; j < n; ++j) sum -= a[i * n + j] * x[j];
    x[i] = sum * a[i * n + i];
  }
}

}  // namespace sprung::dynamics
