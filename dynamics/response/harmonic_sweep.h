#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <vector>

#include "dynamics/linear/frequency_solver.h"
#include "dynamics/response/linear_outputs.h"

namespace sprung::dynamics {

/// Complex matrix stored by rows: read as real numbers it has two columns for each complex one, so that a
/// product with a real matrix from the left is a real product.
using RowsXcd = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// M ẍ + C ẋ + K x = B F and y = P x + V ẋ + D F: g freedoms, f forces, p outputs.
struct DrivenSystem {
  Eigen::MatrixXd mass, damping, stiffness;  ///< g×g
  Eigen::MatrixXd stiffness_rounding;        ///< g×g; if empty, that of a matrix exact to machine precision
  Eigen::MatrixXd input;                     ///< B, g×f
  Eigen::MatrixXd by_position, by_velocity;  ///< p×g
  Eigen::MatrixXd by_force;                  ///< p×f, or empty for none
};

/// A vehicle with some modal coordinates held, under forces on its f independent coordinates (response, eq.
/// 6). Its outputs include the effect of the reactions of the held coordinates, but not the direct effect of
/// the road.
/// @param coordinates  the held ones, as positions in q; may be empty
/// Checked by tests/dynamics/response/harmonic_sweep_test.cpp
DrivenSystem make_held_system(const LinearVehicle& vehicle, const LinearOutputs& outputs,
                              const std::vector<int>& coordinates);

/// Outputs of a system under harmonic forces at many frequencies. The first-order form is transformed to
/// uncoupled blocks of one or two rows once, so that each frequency costs a few products (response, eq. 7). A
/// free mode has its velocity alone as a state. Where the eigenvectors are dependent, or nearly so, a Schur
/// form is used, which is slower.
/// Checked by tests/dynamics/response/harmonic_sweep_test.cpp
class HarmonicSweep {
 public:
  /// @throws support::NumericalError if the mass is not positive definite
  explicit HarmonicSweep(DrivenSystem system);

  /// Forces on the states, the right-hand sides for calc_states().
  /// @param forces  f×k
  /// @return k columns
  RowsXcd project(const Eigen::MatrixXcd& forces) const;
  /// States under projected forces.
  /// @param omega      > 0 [rad/s]; k, one for each column, or 1 for all
  /// @param projected  from project(), k columns
  /// @return s×k
  RowsXcd calc_states(const Eigen::VectorXd& omega, const RowsXcd& projected) const;
  /// Outputs per state, p×s, without the direct effect of the forces.
  const Eigen::MatrixXd& state_outputs() const { return state_outputs_; }
  /// Outputs under forces at their frequencies, computed in portions that fit into a processor's cache.
  /// @param omega  k  @param forces  f×k  @return p×k
  RowsXcd respond(const Eigen::VectorXd& omega, const Eigen::MatrixXcd& forces) const;

  bool is_uncoupled() const { return solver_ == nullptr; }  ///< false if the Schur form is used

 private:
  void uncouple();

  DrivenSystem system_;
  // Uncoupled states u̇ = D u + E F, followed by the positions of the free modes, their velocities divided by
  // s. A row with imaginary part 0 is a block of its own. The others form pairs, the first with a positive
  // part.
  Eigen::VectorXd real_, imaginary_;
  Eigen::MatrixXd input_, state_outputs_, free_rates_;  // E; p×s; velocities of free modes by states u
  std::unique_ptr<FrequencySolver> solver_;
};

/// A X, computed as a real product.
RowsXcd multiply_real_complex(const Eigen::MatrixXd& A, const RowsXcd& X);

}  // namespace sprung::dynamics
