#pragma once

#include <Eigen/Core>

namespace sprung::dynamics {

/// Solves (K + iωC − ω²M) x = F for many ω: one complex Schur form, then a triangular system for each ω.
/// Holds for any C and K, also where eigenvectors are missing (critical damping); f freedoms.
/// (linear, eq. 9)
///
/// The first-order form is taken in the undamped modes with the states (√|k| x, ẋ), so that its rounding is
/// relative to each mode's own frequency and not to the highest one's square.
/// Source: [Golub & Van Loan 2013], §7.1.3 (Schur form), §7.6
class FrequencySolver {
 public:
  /// @param mass  f×f, symmetric, positive definite; damping, stiffness f×f
  /// @throws std::invalid_argument for shapes that do not fit
  /// @throws support::NumericalError if the mass is not positive definite
  FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                  const Eigen::MatrixXd& stiffness);

  /// @param omega  > 0 [rad/s]  @param force  f×k  @return x, f×k
  Eigen::MatrixXcd solve(double omega, const Eigen::MatrixXcd& force) const;

  /// The eigenvalues s of M s² + C s + K, 2f of them [rad/s].
  Eigen::VectorXcd eigenvalues() const { return T_.diagonal(); }

 private:
  Eigen::MatrixXd V_;       // undamped modes, VᵀMV = I
  Eigen::VectorXd scale_;   // √|k| of each [rad/s]
  Eigen::MatrixXcd U_, T_;  // A = U T Uᴴ, 2f×2f
};

}  // namespace sprung::dynamics
