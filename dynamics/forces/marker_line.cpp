#include "dynamics/forces/marker_line.h"

namespace sprung::dynamics {

MarkerLine calc_marker_line(const MarkerState& a, const MarkerState& b) {
  const Eigen::Vector2d span = b.r - a.r;
  MarkerLine line;
  line.length = span.norm();
  line.direction = line.length > 0.0 ? Eigen::Vector2d(span / line.length) : Eigen::Vector2d::Zero();
  line.rate = -line.direction.dot(b.v - a.v);
  return line;
}

}  // namespace sprung::dynamics
