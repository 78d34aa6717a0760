#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/linear/linear_outputs.h"

namespace sprung::dynamics {

/// A linear vehicle under harmonic forcing and under a unit force on each of n modal coordinates, at one
/// frequency: all that it takes to say what holding some of these modes still would change. p outputs.
struct HeldResponse {
  Eigen::VectorXcd outputs;           ///< p, of the vehicle with all modes
  Eigen::VectorXcd amplitudes;        ///< n, of the modal coordinates
  Eigen::MatrixXcd outputs_by_force;  ///< p×n
  Eigen::MatrixXcd receptance;        ///< n×n, modal coordinates by modal forces
};

/// Evaluates a vehicle at one frequency: a factorisation of K̂ + iωĈ − ω²M̂, as there are many right-hand
/// sides.
class HeldResponseSolver {
 public:
  /// @param coordinates  the n modal coordinates  @param vehicle, outputs  have to outlive this
  HeldResponseSolver(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                     std::vector<int> coordinates);

  /// @param force  nq, generalized  @param channels  of all force elements
  HeldResponse solve(double omega, const Eigen::VectorXcd& force, const Eigen::VectorXcd& channels) const;

 private:
  const LinearVehicle* vehicle_;
  const LinearOutputs* outputs_;
  std::vector<int> coordinates_;
  Eigen::MatrixXd modal_;  // n×f, of the modal coordinates by the independent ones
};

/// What the outputs change by when a set of modes is held still, the others keeping on: with Y the outputs by
/// modal forces, H the receptance and η the amplitudes, −Y_S H_SS⁻¹ η_S (mode_choice, eq. 3).
/// @param modes  positions among the n  @return p
Eigen::VectorXcd calc_change(const HeldResponse& response, const std::vector<int>& modes);

}  // namespace sprung::dynamics
