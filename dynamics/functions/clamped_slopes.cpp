#include "dynamics/functions/clamped_slopes.h"

#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>

namespace sprung::dynamics {

std::vector<double> calc_clamped_slopes(std::span<const double> x, std::span<const double> y) {
  if (x.size() < 2 || x.size() != y.size()) {
    throw std::invalid_argument(
        fmt::format("calc_clamped_slopes: needs at least 2 points and as many y as x, got {} and {}",
                    x.size(), y.size()));
  }
  const std::size_t n = x.size();
  for (std::size_t i = 1; i < n; ++i) {
    if (!(x[i] > x[i - 1])) {
      throw std::invalid_argument(
          fmt::format("calc_clamped_slopes: x must ascend, got {} after {}", x[i], x[i - 1]));
    }
  }
  // Continuity of the second derivative gives a tridiagonal system for the slopes m, m₀ = m_{n−1} = 0; by
  // elimination.
  std::vector<double> m(n, 0.0), diagonal(n, 1.0), upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = 1.0 / (x[i] - x[i - 1]);
    const double right = 1.0 / (x[i + 1] - x[i]);
    const double factor = left / diagonal[i - 1];
    diagonal[i] = 2.0 * (left + right) - factor * upper[i - 1];
    upper[i] = right;
    m[i] = 3.0 * ((y[i] - y[i - 1]) * left * left + (y[i + 1] - y[i]) * right * right) - factor * m[i - 1];
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] = (m[i] - upper[i] * m[i + 1]) / diagonal[i];
  return m;
}

}  // namespace sprung::dynamics
