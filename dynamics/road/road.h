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

/// A road h(s): a sequence of smooth segments, between which the slope may jump. s is the distance along the
/// heading; s = 0 is under the leading axle at the start [m]. A segment can be evaluated beyond its ends, so
/// that one step of the integrator uses one smooth function until the end is located.
class Road {
 public:
  virtual ~Road() = default;

  virtual std::string_view shape() const = 0;  ///< as in run files: "half-sine", "table"
  virtual ElementDescription describe() const = 0;

  virtual int num_segments() const = 0;
  /// Where segment k ends and segment k + 1 begins; k < num_segments() − 1.
  virtual double segment_end(int k) const = 0;
  /// @param segment  0-based; s may lie outside
  virtual RoadSample sample(int segment, double s) const = 0;
  /// ∫ h ds from a point that belongs to the segment [m²]; only differences within one segment have a
  /// meaning.
  virtual double integral(int segment, double s) const = 0;
  /// Length of the finest detail of the road near s [m]. An integrator should not travel much further in a
  /// step.
  virtual double resolution(int segment, double s) const = 0;
  /// The least of it in a segment.
  virtual double finest_resolution(int segment) const {
    return resolution(segment, segment_end(segment == 0 ? 0 : segment - 1));
  }

  /// The segment at s. At the end of a segment, it is the one that a wheel enters that rolls forward (or
  /// backward).
  int find_segment(double s, bool forward) const;
  double height(double s) const { return sample(find_segment(s, true), s).height; }
};

/// A road, its position in the world and the direction of travel.
struct PlacedRoad {
  const Road* road = nullptr;
  double direction = 1.0;  ///< +1: s grows with x; −1: s falls with x
  double origin = 0.0;     ///< direction · x at s = 0 [m]

  double distance(double x) const { return direction * x - origin; }
};

}  // namespace sprung::dynamics
