#pragma once

#include <Eigen/Core>
#include <complex>

namespace sprung::dynamics {

/// M ẍ + C ẋ + K x = F as ż = A z + (0, VᵀF) in the undamped modes y = V⁻¹x (linear, eq. 4). The states z are
/// σy of the modes with stiffness, σ = √|ω²|, followed by ẏ of all modes. Free modes, those without
/// stiffness, come first in y, and only their velocities are states. So the rounding of A is relative to the
/// frequency of each mode. Checked by tests/dynamics/linear/frequency_solver_test.cpp
struct FirstOrderForm {
  Eigen::MatrixXd V;          ///< f×f, VᵀMV = 1
  Eigen::Index num_free = 0;  ///< number of free modes
  Eigen::VectorXd scale;      ///< σ of the others [rad/s], f − num_free
  Eigen::VectorXd rounding;   ///< of each ω² (linear, eq. 8) [rad²/s²], f
  Eigen::MatrixXd A;          ///< s×s, s = 2f − num_free

  Eigen::Index num_bound() const { return scale.size(); }
  /// The y that belong to states that vary as e^{st}.
  /// @param states  as many rows as A, k columns
  /// @param s       not 0 [rad/s]
  /// @return f×k
  Eigen::MatrixXcd calc_amplitudes(const Eigen::MatrixXcd& states, std::complex<double> s) const;
};

/// @param mass                f×f, symmetric positive definite
/// @param damping, stiffness  f×f
/// @param rounding            of the stiffness, f×f, ≥ 0
/// @throws support::NumericalError if the mass is not positive definite
FirstOrderForm make_first_order_form(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                     const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding);

/// Bound on the rounding error of eigenvalues of A [rad/s].
double calc_eigenvalue_rounding(const Eigen::VectorXcd& eigenvalues);

/// The test of stability: whether an eigenvalue of A has a real part above its rounding error.
bool has_growth(const Eigen::VectorXcd& eigenvalues);

}  // namespace sprung::dynamics
