#pragma once

#include <span>

#include "dynamics/functions/piecewise_polynomial.h"

namespace sprung::dynamics {

/// a + b
PiecewisePolynomial calc_sum(const PiecewisePolynomial& a, const PiecewisePolynomial& b);
/// a · b
PiecewisePolynomial calc_product(const PiecewisePolynomial& a, const PiecewisePolynomial& b);
/// The function that is parts[k] between ends[k − 1] and ends[k]; parts[0] holds before ends[0], the last one
/// after the last end. It may jump at the ends.
/// @param ends  ascending, at least 1   @param parts  one more than ends
/// @throws std::invalid_argument
/// Checked by tests/dynamics/functions/piecewise_arithmetic_test.cpp
PiecewisePolynomial join_parts(std::span<const double> ends, std::span<const PiecewisePolynomial> parts);

}  // namespace sprung::dynamics
