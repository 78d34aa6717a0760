#pragma once

#include <limits>

#include "dynamics/road/road.h"

namespace sprung::dynamics {

/// Height 0 everywhere.
class FlatRoad final : public Road {
 public:
  std::string_view shape() const override { return "flat"; }
  ElementDescription describe() const override { return {}; }
  int num_segments() const override { return 1; }
  double segment_end(int /*k*/) const override { return std::numeric_limits<double>::infinity(); }
  RoadSample sample(int /*segment*/, double /*s*/) const override { return {}; }
  double integral(int /*segment*/, double /*s*/) const override { return 0.0; }
  double resolution(int /*segment*/, double /*s*/) const override {
    return std::numeric_limits<double>::infinity();
  }
};

}  // namespace sprung::dynamics
