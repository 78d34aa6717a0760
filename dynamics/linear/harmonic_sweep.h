#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <vector>

#include "dynamics/linear/frequency_solver.h"
#include "dynamics/linear/linear_outputs.h"

namespace sprung::dynamics {

/// Complex numbers by rows: as real numbers two columns for each, so that a real matrix multiplies them as it
/// is.
using RowsXcd = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// M ẍ + C ẋ + K x = B F and y = P x + V ẋ + D F: g freedoms, f forces, p outputs.
struct DrivenSystem {
  Eigen::MatrixXd mass, damping, stiffness;  ///< g×g
  Eigen::MatrixXd stiffness_rounding;        ///< g×g; empty: as of a matrix known to all its digits
  Eigen::MatrixXd input;                     ///< B, g×f
  Eigen::MatrixXd by_position, by_velocity;  ///< p×g
  Eigen::MatrixXd by_force;                  ///< p×f, or empty for none
};

/// A vehicle with some modal coordinates held still: forces on its f independent coordinates, outputs without
/// what the road does to them directly, but with what the held coordinates' reaction does
/// (linear, eq. 12).
/// @param coordinates  held, of all; none for the vehicle as it is
DrivenSystem make_held_system(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                              const std::vector<int>& coordinates);

/// Outputs of a system under harmonic forces at many frequencies. The first-order form is brought to
/// uncoupled blocks of one or two rows once, so that a frequency costs a few products (linear, eq. 13). What
/// nothing holds is followed by its velocity alone. Where eigenvectors are (nearly) missing a Schur form
/// serves, exact too but slower.
class HarmonicSweep {
 public:
  /// @throws support::NumericalError if the mass is not positive definite
  explicit HarmonicSweep(DrivenSystem system);

  /// @param forces  f×k  @return what calc_states() takes, k columns
  RowsXcd project(const Eigen::MatrixXcd& forces) const;
  /// @param omega  k, of each column, or one of all [rad/s, > 0]  @return s×k, to be multiplied by
  /// state_outputs()
  RowsXcd calc_states(const Eigen::VectorXd& omega, const RowsXcd& projected) const;
  const Eigen::MatrixXd& state_outputs() const {
    return state_outputs_;
  }  ///< p×s, what F does directly left out
  /// Outputs of forces at their frequencies, in portions that fit into a processor's cache.
  /// @param omega  k  @param forces  f×k  @return p×k
  RowsXcd respond(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& forces) const;

  bool is_uncoupled() const { return solver_ == nullptr; }  ///< not so where the Schur form serves

 private:
  void uncouple();

  DrivenSystem system_;
  // Uncoupled states u̇ = D u + E F, below them the positions of what is free, from its velocities u/s. A row
  // with imaginary part 0 stands alone, the others in pairs, the first positive.
  Eigen::VectorXd real_, imaginary_;
  Eigen::MatrixXd input_, state_outputs_, free_rates_;  // E; p×s; (free)×(states u)
  std::unique_ptr<FrequencySolver> solver_;
};

/// A real matrix times complex rows.
RowsXcd multiply(const Eigen::MatrixXd& A, const RowsXcd& X);

}  // namespace sprung::dynamics
