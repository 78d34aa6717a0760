#pragma once

#include <array>
#include <cmath>

namespace sprung::fem {

/// A point of Gauss–Legendre quadrature on 0 … 1.
struct GaussPoint {
  double xi, weight;
};

/// Four points, exact to degree 7: products of two cubic shape functions have degree 6.
inline std::array<GaussPoint, 4> make_gauss_points() {
  const double inner = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double outer = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double inner_weight = (18.0 + std::sqrt(30.0)) / 72.0;
  const double outer_weight = (18.0 - std::sqrt(30.0)) / 72.0;
  return {{{0.5 - 0.5 * outer, outer_weight},
           {0.5 - 0.5 * inner, inner_weight},
           {0.5 + 0.5 * inner, inner_weight},
           {0.5 + 0.5 * outer, outer_weight}}};
}

}  // namespace sprung::fem
