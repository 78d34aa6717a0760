#pragma once

#include <Eigen/Core>

#include "dynamics/linear/first_order_form.h"

namespace sprung::dynamics {

/// Solves (K + iωC − ω²M) x = F for many ω: one complex Schur form, then a triangular system for each ω
/// (linear, eq. 4). Any C and K are allowed, also those without a basis of eigenvectors (critical damping).
/// f freedoms.
/// Source: [Golub & Van Loan 2013], §7.1.3 (Schur form), §7.6 — checked by
/// tests/dynamics/linear/frequency_solver_test.cpp
class FrequencySolver {
 public:
  /// @param mass                f×f, symmetric, positive definite
  /// @param damping, stiffness  f×f
  /// @param rounding            of the stiffness, f×f: a mode without more stiffness than this is free
  /// @throws std::invalid_argument for shapes that do not fit
  /// @throws support::NumericalError if the mass is not positive definite
  FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                  const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding);
  /// With the rounding of a stiffness that is exact to machine precision.
  FrequencySolver(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                  const Eigen::MatrixXd& stiffness);

  /// @param omega  > 0 [rad/s]  @param force  f×k  @return x, f×k
  Eigen::MatrixXcd solve(double omega, const Eigen::MatrixXcd& force) const;

  /// The eigenvalues s of M s² + C s + K [rad/s]; a free mode has only the one of its velocity.
  Eigen::VectorXcd eigenvalues() const { return T_.diagonal(); }

 private:
  FirstOrderForm form_;
  Eigen::MatrixXcd U_, T_;  // A = U T Uᴴ
};

}  // namespace sprung::dynamics
