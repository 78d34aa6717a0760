#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/response/linear_outputs.h"

namespace sprung::dynamics {

/// Response of a linear vehicle at one frequency to its forcing, and to a unit force on each of n modal
/// coordinates. From these follows the effect of holding some of the modes. p outputs.
struct HeldResponse {
  Eigen::VectorXcd outputs;           ///< p, of the vehicle with all modes
  Eigen::VectorXcd amplitudes;        ///< n, of the modal coordinates
  Eigen::MatrixXcd outputs_by_force;  ///< p×n, outputs per unit modal force
  Eigen::MatrixXcd receptance;        ///< n×n, modal coordinates per unit modal force
};

/// Computes these responses, at each frequency by one factorisation of K̂ + iωĈ − ω²M̂.
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
class HeldResponseSolver {
 public:
  /// @param vehicle, outputs  must outlive this
  /// @param coordinates       the n modal coordinates, as positions in q
  HeldResponseSolver(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                     std::vector<int> coordinates);

  /// @param omega     [rad/s]
  /// @param force     generalized forces, nq
  /// @param channels  direct part of the channels of all force elements
  HeldResponse solve(double omega, const Eigen::VectorXcd& force, const Eigen::VectorXcd& channels) const;

 private:
  const LinearVehicle* vehicle_;
  const LinearOutputs* outputs_;
  std::vector<int> coordinates_;
  Eigen::MatrixXd modal_;  // n×f, of the modal coordinates by the independent ones
};

/// Change of the outputs when a set S of modes is held and the others are not: −Y_S H_SS⁻¹ η_S with Y the
/// outputs per modal force, H the receptance and η the amplitudes (mode_choice, eq. 3).
/// @param modes  positions among the n
/// @return p
/// Checked by tests/dynamics/mode_choice/basis_choice_test.cpp
Eigen::VectorXcd calc_change(const HeldResponse& response, const std::vector<int>& modes);

}  // namespace sprung::dynamics
