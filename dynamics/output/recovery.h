#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body.h"
#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Stress resultants of the beams of a flexible body from its active modes. There is one station at each end
/// of each element, in the superelement's order of elements, first end first.
class ResultantRecovery {
 public:
  ResultantRecovery(const reduce::Superelement& superelement, const Body& body);
  int num_stations() const { return static_cast<int>(axial_.rows()); }
  /// Undeformed positions of the stations, body axes, stations×2 [m].
  const Eigen::MatrixXd& positions() const { return positions_; }

  Eigen::VectorXd axial(const Eigen::VectorXd& eta) const { return axial_ * eta; }    ///< N [N]
  Eigen::VectorXd shear(const Eigen::VectorXd& eta) const { return shear_ * eta; }    ///< Q [N]
  Eigen::VectorXd moment(const Eigen::VectorXd& eta) const { return moment_ * eta; }  ///< M [N·m]

 private:
  Eigen::MatrixXd positions_, axial_, shear_, moment_;
};

}  // namespace sprung::dynamics
