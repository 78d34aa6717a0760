#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/input/make_model.h"
#include "dynamics/input/vehicle.h"
#include "dynamics/linear/equilibrium.h"
#include "dynamics/road/road.h"
#include "dynamics/simulation/transient.h"

namespace sprung::test {

/// The reference truck: dynamics/models/truck/vehicle.toml with the superelements made from meshes/truck.
/// @param changes  overrides of the vehicle file's keys, "forces.front_tyre.damping=0"
dynamics::Vehicle read_truck(const std::vector<std::string>& changes = {});

/// The truck with the lowest chassis modes active and rigid arms.
dynamics::Model make_truck(const dynamics::Vehicle& vehicle, int num_chassis_modes,
                           const dynamics::PlacedRoad& road, const dynamics::ModalDamping& damping = {});

/// Assembled start positions of the vehicle file, moved along x.
Eigen::VectorXd assemble_truck(const dynamics::Model& model, const dynamics::Vehicle& vehicle,
                               double shift = 0.0);

/// The same model seen in a mirror: x against −x. Forces on a road need the mirrored road in their place
/// already.
void mirror_model(dynamics::Model& model);
/// Coordinates or velocities of the mirrored model.
Eigen::VectorXd mirror_coordinates(const dynamics::Model& model, const Eigen::VectorXd& q);

/// Static equilibrium of the truck on flat ground.
struct TruckAtRest {
  explicit TruckAtRest(int num_chassis_modes, double shift = 0.0, bool mirrored = false);
  dynamics::Vehicle vehicle;
  dynamics::Model model;
  dynamics::Equilibrium equilibrium;
  Eigen::VectorXd chassis() const;  ///< x, y, angle of its frame
};

/// The bump at 3 m/s: half-sine, 0.2 m high, from 1.0 to 1.4 m.
struct BumpRun {
  int num_chassis_modes = 0;
  double relative_tolerance = 1e-6;
  double duration = 5.0;  ///< [s]
  double shift = 0.0;     ///< of the start along x [m]
  bool mirrored = false;  ///< mirrored truck, driving towards +x
  dynamics::SteppingMethod method = dynamics::SteppingMethod::kExponential;
};
struct BumpResult {
  /// Chassis frame at each output (1 ms): distance along the heading and height from static equilibrium [m],
  /// angle [rad], mirrored back where the truck was mirrored; 3×outputs.
  Eigen::Matrix3Xd chassis;
  Eigen::VectorXd acceleration;        ///< of the chassis frame, vertical, at each output [m/s²]
  double lowest = 0.0, highest = 0.0;  ///< of the height
  double largest_violation = 0.0;      ///< of the constraints [m]
  double closure = 0.0;                ///< of the energy book
  dynamics::TransientStatistics statistics;
  std::vector<dynamics::Event> events;
};
BumpResult drive_over_bump(const BumpRun& run);

/// The start of such a run: the truck at rest, its wheels about to roll.
struct BumpStart {
  explicit BumpStart(const BumpRun& run);
  TruckAtRest rest;
  double direction;       ///< of travel along x
  dynamics::Model model;  ///< on the road with the bump
  dynamics::State state;
};

/// The imbalance of the energy book, relative to the largest sum of the absolute changes of the stored
/// energies.
class EnergyClosure {
 public:
  void add(const dynamics::EnergyBook& book);
  double value() const { return largest_error_ / largest_change_; }

 private:
  bool has_first_ = false;
  dynamics::EnergyBook first_;
  double largest_error_ = 0.0, largest_change_ = 0.0;
};

}  // namespace sprung::test
