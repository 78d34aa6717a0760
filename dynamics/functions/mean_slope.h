#pragma once

#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// Slope of the linear law that is nearest to a law F, by least mean square, about a mean v₀ for a normal
/// variable v: c = E[F(v₀ + v) v]/σ² = E[F′(v₀ + v)] (functions, eq. 5)
/// @param law    continuous
/// @param sigma  root mean square of v, > 0
/// @param mean   v₀
/// @throws std::invalid_argument if sigma is not positive
/// Checked by tests/dynamics/functions/mean_slope_test.cpp
double calc_mean_slope(const PiecewisePolynomial& law, double sigma, double mean = 0.0);

/// Whether it has the same slope everywhere, to rounding.
bool has_one_slope(const PiecewisePolynomial& law);

}  // namespace sprung::dynamics
