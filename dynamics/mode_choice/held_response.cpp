#include "dynamics/mode_choice/held_response.h"

#include <complex>
#include <utility>

#include "tools/support/dense/dense_solvers.h"

namespace sprung::dynamics {

HeldResponseSolver::HeldResponseSolver(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       std::vector<int> coordinates)
    : vehicle_(&vehicle), outputs_(&outputs), coordinates_(std::move(coordinates)) {
  modal_ = vehicle.system().directions(coordinates_, Eigen::all);
}

HeldResponse HeldResponseSolver::solve(double omega, const Eigen::VectorXcd& force,
                                       const Eigen::VectorXcd& channels) const {
  const LinearisedSystem& system = vehicle_->system();
  const Eigen::Index n = modal_.rows();
  const std::complex<double> s(0.0, omega);
  const Eigen::MatrixXcd Z = system.stiffness + s * system.damping + s * s * system.mass;
  Eigen::MatrixXcd right(Z.rows(), n + 1);
  right.col(0) = system.directions.transpose() * force;
  right.rightCols(n) = modal_.transpose().cast<std::complex<double>>();
  const Eigen::MatrixXcd x = support::solve_lu(Z, right);
  const Eigen::MatrixXcd eta = modal_ * x;
  // Modal forces have no direct effect on the channels.
  const Eigen::MatrixXcd by_motion =
      outputs_->by_position + s * outputs_->by_velocity + (s * s) * outputs_->by_acceleration;
  return {.outputs = sum_outputs(*outputs_, omega, x.col(0), force, channels),
          .amplitudes = eta.col(0),
          .outputs_by_force = by_motion * x.rightCols(n) + outputs_->by_force(Eigen::all, coordinates_),
          .receptance = eta.rightCols(n)};
}

Eigen::VectorXcd calc_change(const HeldResponse& response, const std::vector<int>& modes) {
  const Eigen::MatrixXcd H = response.receptance(modes, modes);
  const Eigen::VectorXcd eta = response.amplitudes(modes);
  const Eigen::VectorXcd holding = support::solve_lu(H, eta);
  return -response.outputs_by_force(Eigen::all, modes) * holding;
}

}  // namespace sprung::dynamics
