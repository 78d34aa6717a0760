#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/response/harmonic_sweep.h"
#include "dynamics/response/linear_vehicle.h"

namespace sprung::dynamics {

/// What force elements exert beyond their linear laws while the vehicle moves as predicted: two-rate dampers,
/// stops, springs whose rate changes (mode_choice, eq. 7). m lines of a Fourier series.
struct NonlinearForces {
  std::vector<std::string> elements;  ///< that exert the most of such forces
  Eigen::VectorXd omega;              ///< m, circular frequencies [rad/s]
  Eigen::MatrixXcd forces;            ///< f×m, on the independent coordinates; 0 columns without elements
};

/// Tyres on the road, elements with states of their own and forces given in time are left out.
/// @param omega      k ascending circular frequencies, multiples of the first
/// @param forces     of the linear prediction at these, f×k
/// @param num_lines  m ≥ k
/// Checked by tests/dynamics/mode_choice/nonlinear_forces_test.cpp
NonlinearForces calc_nonlinear_forces(const LinearVehicle& vehicle, const Eigen::VectorXd& omega,
                                      const Eigen::MatrixXcd& forces, Eigen::Index num_lines);

/// Elements whose states are far from linear, as those of friction: no prediction contains that.
std::vector<std::string> list_unpredictable(const LinearVehicle& vehicle);

}  // namespace sprung::dynamics
