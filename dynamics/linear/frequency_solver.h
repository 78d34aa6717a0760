#pragma once

#include <Eigen/Core>

#include "dynamics/linear/first_order_form.h"

namespace sprung::dynamics {

/// Solves (K + iωC − ω²M) x = F for many ω: one complex Schur form, then a triangular system for each ω.
/// Holds for any C and K, also where eigenvectors are missing (critical damping); f freedoms.
/// (linear, eq. 9)
/// Source: [Golub & Van Loan 2013], §7.1.3 (Schur form), §7.6
class FrequencySolver {
 public:
  /// @param mass  f×f, symmetric, positive definite; damping, stiffness f×f
  /// @param rounding  of the stiffness, f×f: a mode with no more stiffness counts as free
  /// @throws std::invalid_argument for shapes that do not fit
  /// @throws support::NumericalError if the mass is not positive definite
  FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                  const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding);
  /// For a stiffness known to all its digits.
  FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                  const Eigen::MatrixXd& stiffness);

  /// @param omega  > 0 [rad/s]  @param force  f×k  @return x, f×k
  Eigen::MatrixXcd solve(double omega, const Eigen::MatrixXcd& force) const;

  /// The eigenvalues s of M s² + C s + K [rad/s], but of a free mode that of its velocity alone.
  Eigen::VectorXcd eigenvalues() const { return T_.diagonal(); }

 private:
  FirstOrderForm form_;
  Eigen::MatrixXcd U_, T_;  // A = U T Uᴴ
};

}  // namespace sprung::dynamics
