#include "dynamics/analysis/held_response.h"

#include <Eigen/LU>
#include <complex>
#include <utility>

namespace sprung::dynamics {

namespace {

// Left factor L (unit diagonal) and right factor U of a matrix in place, without exchange of rows: leading parts of
// the factors are those of the leading parts.
void factorise(Eigen::MatrixXcd& A) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const Eigen::Index rest = n - k - 1;
    A.col(k).tail(rest) /= A(k, k);
    A.bottomRightCorner(rest, rest).noalias() -= A.col(k).tail(rest) * A.row(k).tail(rest);
  }
}

}  // namespace

HeldResponseSolver::HeldResponseSolver(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                                       std::vector<int> coordinates)
    : vehicle_(&vehicle), outputs_(&outputs), coordinates_(std::move(coordinates)) {
  modal_ = vehicle.system().directions(coordinates_, Eigen::all);
}

Eigen::VectorXcd HeldResponseSolver::calc_outputs(double omega, const Eigen::VectorXcd& force,
                                                  const Eigen::VectorXcd& channels) const {
  const LinearisedSystem& system = vehicle_->system();
  const std::complex<double> s(0.0, omega);
  const Eigen::MatrixXcd Z = system.stiffness + s * system.damping + s * s * system.mass;
  const Eigen::VectorXcd x = Eigen::PartialPivLU<Eigen::MatrixXcd>(Z).solve(system.directions.transpose() * force);
  return sum_outputs(*outputs_, omega, x, force, channels);
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
  const Eigen::MatrixXcd x = Eigen::PartialPivLU<Eigen::MatrixXcd>(Z).solve(right);
  const Eigen::MatrixXcd eta = modal_ * x;
  // Modal forces act on no channel directly.
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
  const Eigen::VectorXcd holding = Eigen::PartialPivLU<Eigen::MatrixXcd>(H).solve(eta);
  return -response.outputs_by_force(Eigen::all, modes) * holding;
}

Eigen::MatrixXcd calc_nested_changes(const HeldResponse& response, const std::vector<int>& order) {
  Eigen::MatrixXcd H = response.receptance(order, order);
  factorise(H);
  const Eigen::VectorXcd z =
      H.triangularView<Eigen::UnitLower>().solve(Eigen::VectorXcd(response.amplitudes(order)));
  Eigen::MatrixXcd changes = response.outputs_by_force(Eigen::all, order);
  H.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(changes);
  for (Eigen::Index j = 0; j < changes.cols(); ++j) {
    changes.col(j) *= -z[j];
    if (j > 0) changes.col(j) += changes.col(j - 1);
  }
  return changes;
}

}  // namespace sprung::dynamics
