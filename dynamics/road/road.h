#pragma once

#include <cstddef>
#include <string_view>

#include "dynamics/description/element_description.h"

namespace sprung::dynamics {

/// Height of a road and its derivatives with respect to the distance along it.
struct RoadSample {
  double height = 0.0;  ///< [m]
  double slope = 0.0;   ///< dh/ds
};

/// A road h(s): smooth segments, one after the other, with jumps of slope only between them. s is the
/// distance along the heading from under the leading axle at the start [m]. A segment can be evaluated beyond
/// its ends, so that a step of the integrator sees a smooth function until the end is located.
class Road {
 public:
  virtual ~Road() = default;

  virtual std::string_view shape() const = 0;  ///< as in run files: "half-sine", "table"
  virtual ElementDescription describe() const = 0;

  virtual int num_segments() const = 0;
  /// End of segment k, where segment k + 1 begins; k < num_segments() − 1.
  virtual double segment_end(int k) const = 0;
  /// @param segment  0-based; s may lie outside
  virtual RoadSample sample(int segment, double s) const = 0;
  /// ∫ of the height over s, from a place of the segment's own [m²]: differences within a segment count.
  virtual double integral(int segment, double s) const = 0;
  /// Distance over which the road at s holds nothing finer [m]: an integrator should not go much further in a
  /// step.
  virtual double resolution(int segment, double s) const = 0;

  /// The segment at s; at an end, the one that a wheel rolling forward (or backward) comes into.
  int find_segment(double s, bool forward) const;
  double height(double s) const { return sample(find_segment(s, true), s).height; }
};

/// Where a road lies in the world, and which way it is travelled.
struct PlacedRoad {
  const Road* road = nullptr;
  double direction = 1.0;  ///< +1: s grows with x; −1: against it
  double origin = 0.0;     ///< direction · x of s = 0 [m]

  double distance(double x) const { return direction * x - origin; }
};

}  // namespace sprung::dynamics
