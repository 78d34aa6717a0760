#pragma once

#include <vector>

#include "dynamics/system/model.h"

namespace sprung::dynamics {

/// The scales of errors: a step may make an error of the relative tolerance times the scale of a quantity
/// (integration, "Error control"). None depends on where the origin is.
class ErrorScales {
 public:
  explicit ErrorScales(const Model& model);

  double position(int coordinate) const;                   ///< in the coordinate's unit
  double velocity(int coordinate, double velocity) const;  ///< in the coordinate's unit/s
  double energy() const;                                   ///< [J]

 private:
  std::vector<double> natural_;  // of each coordinate
  double velocity_scale_;        // [natural sizes/s]
  double energy_scale_;          // [J]
};

}  // namespace sprung::dynamics
