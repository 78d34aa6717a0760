#pragma once

#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// What a wheel's circle and the road have in common, and how it changes as the wheel moves: with the wheel's
/// centre at distance s and height y, e(ξ) = h(s + ξ) − y + √(R² − ξ²) is how deep the road stands in the
/// circle at s + ξ, and
///
///     area = ∫ max(0, e) dξ,   ∂area/∂y = −width,   ∂area/∂s = rise            (forces, eq. 7)
struct WheelOverlap {
  double area = 0.0;         ///< [m²]
  double width = 0.0;        ///< of what touches, along the road [m]
  double rise = 0.0;         ///< of the road over what touches [m]
  double depth = 0.0;        ///< largest e; negative: how far the wheel is above the road [m]
  double depth_slope = 0.0;  ///< ∂depth/∂s: slope of the circle there, and of the road unless it has a corner
};

/// Exact but for what the road hides between samples 2R/num_cells apart, to which the ends of its segments
/// come; no allocation. For roads below the wheel's centre: all of a higher one counts as standing in the
/// circle.
/// @param s, y       of the wheel's centre [m]
/// @param radius     > 0 [m]
/// @param num_cells  ≥ 2
WheelOverlap calc_wheel_overlap(const Road& road, double s, double y, double radius, int num_cells);

/// Overlap of a wheel with level ground, by penetration: R² (α − sin α cos α), cos α = 1 − δ/R.
/// @param penetration  from 0 to radius [m] @return [m²]
double calc_level_overlap(double radius, double penetration);
/// The penetration on level ground that gives an overlap, its inverse.
/// @param area  ≥ 0, more than half the wheel's counts as half [m²] @return [m]
double find_level_penetration(double radius, double area);

}  // namespace sprung::dynamics
