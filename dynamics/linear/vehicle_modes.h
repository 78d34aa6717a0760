#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/linear/equilibrium.h"

namespace sprung::dynamics {

/// A body with at least 5 % of the kinetic energy of a mode.
struct Participant {
  int body = 0;
  double share = 0.0;  ///< of the mode's kinetic energy
  int main_mode = 0;   ///< number of the body's own mode with the largest amplitude; 0: it moves as a whole
  Eigen::Vector3d motion =
      Eigen::Vector3d::Zero();  ///< of the undeformed body: its centre of mass x, y; turning
};

/// One vibration of the assembled vehicle about its equilibrium.
struct VehicleMode {
  double undamped_frequency_hz = 0.0;  ///< 0 for a rigid-body mode
  double largest_frequency_hz = 0.0;   ///< the undamped one at most, with the rounding of the stiffness
  double damped_frequency_hz = 0.0;    ///< 0 where the mode does not oscillate
  double damping_ratio = 0.0;  ///< ζ (linear, eqs. 3, 13): at least 1 where a damped mode does not oscillate
  /// −s of a mode with stiffness that does not oscillate: it decays by e in the inverse of this time [1/s].
  std::optional<double> decay_rate;
  bool is_rigid_body = false;  ///< no element resists it at rest; internal states may make it oscillate
  Eigen::VectorXd shape;       ///< nq, undamped, mass-normalised
  std::vector<Participant> participants;  ///< the bodies that move, that with the most kinetic energy first
};

/// Modes of the linearised vehicle: undamped ones from M̂ and K̂, each with the eigenvalue of the damped system
/// whose shape is most similar. Rigid-body modes come first, then ascending frequencies (linear, eqs. 1–3).
/// @throws support::NumericalError if the equilibrium is unstable
/// Checked by tests/dynamics/linear/vehicle_modes_test.cpp
std::vector<VehicleMode> calc_vehicle_modes(const Model& model, const Equilibrium& equilibrium);

}  // namespace sprung::dynamics
