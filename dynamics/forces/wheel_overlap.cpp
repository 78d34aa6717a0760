#include "dynamics/forces/wheel_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace sprung::dynamics {

namespace {

// ∫ √(R² − ξ²) dξ from 0.
double calc_circle_integral(double radius, double xi) {
  const double half = std::sqrt(std::max(0.0, radius * radius - xi * xi));
  return 0.5 * (xi * half + radius * radius * std::asin(std::clamp(xi / radius, -1.0, 1.0)));
}

// e(ξ) and its slope on one segment of the road.
struct Depth {
  const Road& road;
  double s, y, radius;
  int segment;

  struct Sample {
    double at, value, slope, road_slope, road_height;
  };
  Sample sample(double xi) const {
    const RoadSample point = road.sample(segment, s + xi);
    const double half = std::sqrt(std::max(0.0, radius * radius - xi * xi));
    const double circle_slope =
        half > 0.0 ? xi / half : std::copysign(std::numeric_limits<double>::infinity(), xi);
    return {xi, point.height - y + half, point.slope - circle_slope, point.slope, point.height};
  }

  // The zero of e, or of its slope, between two places where its signs differ. For e: Newton's method, with
  // halving where it would leave the bracket. For the slope halving is enough, since its error has a
  // second-order effect.
  Sample find_zero(Sample left, Sample right) const {
    double guess = 0.5 * (left.at + right.at);
    for (int iteration = 0; iteration < 60; ++iteration) {
      const Sample middle = sample(guess);
      if (middle.value == 0.0) return middle;
      ((middle.value > 0.0) == (right.value > 0.0) ? right : left) = middle;
      double next = middle.at - middle.value / middle.slope;
      if (!(next > left.at && next < right.at)) next = 0.5 * (left.at + right.at);
      if (std::abs(next - guess) <= 1e-15 * radius) return sample(next);
      guess = next;
    }
    return sample(guess);
  }
  Sample find_level(Sample left, Sample right) const {
    while (right.at - left.at > 1e-9 * radius) {
      const Sample middle = sample(0.5 * (left.at + right.at));
      ((middle.slope > 0.0) == (right.slope > 0.0) ? right : left) = middle;
    }
    return left.value > right.value ? left : right;
  }
};

void take_deepest(const Depth::Sample& sample, WheelOverlap& overlap) {
  if (sample.value <= overlap.depth) return;
  overlap.depth = sample.value;
  // At a maximum of e inside a segment, circle and road have the same slope. At a corner of the road, which
  // does not move, only the slope of the circle counts.
  overlap.depth_slope = std::isfinite(sample.slope) ? sample.road_slope - sample.slope : sample.road_slope;
}

// Adds the part between two places, all of which touches the wheel.
void add_touching(const Depth& depth, const Depth::Sample& left, const Depth::Sample& right,
                  WheelOverlap& overlap) {
  const double width = right.at - left.at;
  const double road = depth.road.integral(depth.segment, depth.s + right.at) -
                      depth.road.integral(depth.segment, depth.s + left.at);
  const double circle =
      calc_circle_integral(depth.radius, right.at) - calc_circle_integral(depth.radius, left.at);
  overlap.area += road - depth.y * width + circle;
  overlap.width += width;
  overlap.rise += right.road_height - left.road_height;
}

// Adds one cell, in which e has at most one maximum or minimum.
void add_cell(const Depth& depth, const Depth::Sample& left, const Depth::Sample& right,
              WheelOverlap& overlap) {
  const bool touches_left = left.value > 0.0, touches_right = right.value > 0.0;
  take_deepest(left, overlap);
  take_deepest(right, overlap);
  const bool has_maximum = left.slope > 0.0 && right.slope < 0.0,
             has_minimum = left.slope < 0.0 && right.slope > 0.0;
  if (touches_left != touches_right) {
    if (has_maximum) take_deepest(depth.find_level(left, right), overlap);
    const Depth::Sample edge = depth.find_zero(left, right);
    if (touches_left)
      add_touching(depth, left, edge, overlap);
    else
      add_touching(depth, edge, right, overlap);
    return;
  }
  if (!has_maximum && !(has_minimum && touches_left)) {
    if (touches_left) add_touching(depth, left, right, overlap);
    return;
  }
  const Depth::Sample level = depth.find_level(left, right);
  take_deepest(level, overlap);
  const bool touches_inside = level.value > 0.0;
  if (touches_inside == touches_left) {
    if (touches_left) add_touching(depth, left, right, overlap);
  } else if (touches_inside) {
    add_touching(depth, depth.find_zero(left, level), depth.find_zero(level, right), overlap);
  } else {  // the wheel bridges a hole
    add_touching(depth, left, depth.find_zero(left, level), overlap);
    add_touching(depth, depth.find_zero(level, right), right, overlap);
  }
}

}  // namespace

WheelOverlap calc_wheel_overlap(const Road& road, double s, double y, double radius, int num_cells) {
  WheelOverlap overlap;
  overlap.depth = -std::numeric_limits<double>::infinity();
  Depth depth{road, s, y, radius, road.find_segment(s - radius, true)};
  double begin = -radius;
  for (int cell = 1; cell <= num_cells; ++cell) {
    const double cell_end = cell == num_cells ? radius : radius * (2.0 * cell / num_cells - 1.0);
    while (begin < cell_end) {
      const bool is_last = depth.segment == road.num_segments() - 1;
      const double segment_end =
          is_last ? std::numeric_limits<double>::infinity() : road.segment_end(depth.segment) - s;
      const double end = std::min(cell_end, segment_end);
      if (end > begin) add_cell(depth, depth.sample(begin), depth.sample(end), overlap);
      begin = std::max(begin, end);
      if (segment_end <= cell_end) ++depth.segment;
    }
  }
  overlap.area = std::max(0.0, overlap.area);  // rounding of a difference of larger areas
  return overlap;
}

double find_level_penetration(double radius, double area) {
  if (!(area > 0.0)) return 0.0;
  const double target = std::min(2.0 * area / (radius * radius), std::numbers::pi);  // 2α − sin 2α
  double twice = std::cbrt(6.0 * target);  // exact in the limit of small areas, else below the solution
  for (int iteration = 0; iteration < 30; ++iteration) {
    // x − sin x without cancellation where x is small: x³/6 (1 − x²/20 (1 − x²/42 (1 − x²/72 (1 − x²/110))))
    const double x2 = twice * twice;
    const double gap =
        twice > 0.5 ? twice - std::sin(twice)
                    : twice * x2 / 6.0 *
                          (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0))));
    const double sine = std::sin(0.5 * twice);
    const double step = (target - gap) / (2.0 * sine * sine);
    twice += step;
    if (std::abs(step) <= 1e-15 * twice) break;
  }
  const double sine = std::sin(0.25 * twice);
  return 2.0 * radius * sine * sine;  // R (1 − cos α)
}

}  // namespace sprung::dynamics
