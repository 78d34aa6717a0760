#pragma once

#include <Eigen/Core>
#include <vector>

#include "reduce/superelement/superelement.h"
#include "tests/reduce/free_body_truth.h"

namespace sprung::reduce::testing {

/// A body in coordinates of any kind: all freedoms of the full model, or a rigid motion and the vectors of a
/// superelement. So full and reduced vehicles are made in the same way.
struct CoupledBody {
  Eigen::MatrixXd stiffness, mass;  ///< n×n
  Eigen::MatrixXd motion;           ///< b×n, of the interface freedoms
};
CoupledBody make_full_body(const fem::BeamModel& model, const std::vector<InterfaceFreedom>& interface);
CoupledBody make_reduced_body(const Superelement& superelement,
                              const std::vector<InterfaceFreedom>& interface);

/// A vehicle with small vibrations and no damping of its own.
struct CoupledVehicle {
  Eigen::MatrixXd stiffness, mass;
  Eigen::MatrixXd reactions;  ///< r×n, forces in the joints for a displacement
  Eigen::VectorXd load;       ///< n, of a unit force
};

/// Cab, engine, box and two axles on the stiff joints of the ladder frame.
CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder, const CoupledBody& frame);
CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder);
CoupledVehicle make_ladder_vehicle(const LadderFrame& ladder, const Superelement& superelement);

/// Two bodies whose interface freedoms are the same: welded. Both have the same number of them.
CoupledVehicle weld(const CoupledBody& first, const CoupledBody& second);

/// Frequencies, ascending, without rigid motions (below 0.1 Hz) [Hz].
Eigen::VectorXd calc_frequencies(const CoupledVehicle& vehicle);

/// The largest relative errors of a vehicle up to a frequency.
struct VehicleError {
  double frequency = 0.0;
  double reaction =
      0.0;  ///< r.m.s. over 0 … highest_hz of each joint's force under the load, 2 % loss factor
};
VehicleError compare_vehicles(const CoupledVehicle& vehicle, const CoupledVehicle& truth, double highest_hz);

}  // namespace sprung::reduce::testing
