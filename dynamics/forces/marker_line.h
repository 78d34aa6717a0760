#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/marker.h"

namespace sprung::dynamics {

/// The line from one marker to another, along which an element acts.
struct MarkerLine {
  Eigen::Vector2d direction;  ///< from a to b; zero for markers at one place, between which there is no force
  double length;              ///< [m]
  double rate;                ///< at which it becomes shorter [m/s]
};

MarkerLine calc_marker_line(const MarkerState& a, const MarkerState& b);

}  // namespace sprung::dynamics
