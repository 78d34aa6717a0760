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
  /// Likewise such that vibration of a modal coordinate at its body's frequency has the tolerance in
  /// accelerations, too, where errors of many steps add up.
  double position_in_vibration(int coordinate) const;
  double velocity_in_vibration(int coordinate, double velocity) const;
  double energy() const;  ///< [J]

 private:
  std::vector<double> natural_;    // of each coordinate
  std::vector<double> frequency_;  // of each modal coordinate alone, 0 of others [rad/s]
  double velocity_scale_;          // [natural sizes/s]
  double energy_scale_;            // [J]
};

}  // namespace sprung::dynamics
