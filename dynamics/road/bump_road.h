#pragma once

#include <string>
#include <vector>

#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// The shapes a bump can have; u = (s − start)/length from 0 to 1.
enum class BumpShape {
  kHalfSine,   ///< height · sin(πu)
  kHaversine,  ///< height · (1 − cos(2πu))/2, no kink at its ends
  kTriangle,   ///< straight up to the middle and down again
  kRamp,       ///< straight up; the road stays at `height` after it
};

/// The names of the shapes in run files, in the order of BumpShape: "half-sine", …
const std::vector<std::string>& bump_shape_names();

/// A flat road with one bump.
class BumpRoad final : public Road {
 public:
  struct Parameters {
    BumpShape shape = BumpShape::kHalfSine;
    double start = 0.0;   ///< [m]
    double length = 1.0;  ///< > 0 [m]
    double height = 0.0;  ///< may be negative: a hole [m]
  };
  /// @throws std::invalid_argument if length is not positive
  explicit BumpRoad(const Parameters& parameters);

  std::string_view shape() const override;
  ElementDescription describe() const override;
  int num_segments() const override;
  double segment_end(int k) const override;
  RoadSample sample(int segment, double s) const override;
  double integral(int segment, double s) const override;
  double resolution(int segment, double s) const override;

 private:
  Parameters parameters_;
};

}  // namespace sprung::dynamics
