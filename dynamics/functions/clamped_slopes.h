#pragma once

#include <span>
#include <vector>

namespace sprung::dynamics {

/// Slopes at the points of the cubic spline through them that is twice continuously differentiable and level
/// at both ends.
/// Source: [de Boor 2001], ch. IV, complete spline interpolation
/// @param x  ascending, at least 2; y as many
/// @throws std::invalid_argument
std::vector<double> calc_clamped_slopes(std::span<const double> x, std::span<const double> y);

}  // namespace sprung::dynamics
