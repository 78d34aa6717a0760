#pragma once

#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// The overlap of a wheel's circle and the road, and its derivatives by the position of the wheel. The centre
/// of the wheel is at distance s and height y. e(ξ) = h(s + ξ) − y + √(R² − ξ²) is the depth of the road in
/// the circle at s + ξ, and
///
///     area = ∫ max(0, e) dξ,   ∂area/∂y = −width,   ∂area/∂s = rise            (forces, eq. 7)
struct WheelOverlap {
  double area = 0.0;         ///< [m²]
  double width = 0.0;        ///< length of road that touches the wheel [m]
  double rise = 0.0;         ///< change of the road's height over that length [m]
  double depth = 0.0;        ///< largest e; while negative, −e is the gap between wheel and road [m]
  double depth_slope = 0.0;  ///< ∂depth/∂s
};

/// The overlap. It is exact except for details of the road between samples; the samples are 2R/num_cells
/// apart, and at the ends of the road's segments. It allocates no memory. The road must be below the wheel's
/// centre: a higher road counts as if it were in the circle with all of its height.
/// @param s, y       position of the wheel's centre [m]
/// @param radius     > 0 [m]
/// @param num_cells  ≥ 2
WheelOverlap calc_wheel_overlap(const Road& road, double s, double y, double radius, int num_cells);

/// The penetration δ of level ground with an overlap R² (α − sin α cos α), cos α = 1 − δ/R (forces, eq. 8).
/// @param area  ≥ 0; more than half of the wheel's area counts as half [m²] @return [m]
double find_level_penetration(double radius, double area);

}  // namespace sprung::dynamics
