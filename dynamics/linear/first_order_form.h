#pragma once

#include <Eigen/Core>
#include <complex>

namespace sprung::dynamics {

/// M ẍ + C ẋ + K x = F as d/dt z = A z + (0, VᵀF) in the undamped modes y = V⁻¹x: the states z are σy of the
/// modes with stiffness, σ = √|ω²|, and below them ẏ of all. Modes that nothing holds come first, and only
/// their velocities are states (linear, eq. 9). So the rounding of A is relative to each mode's own
/// frequency.
struct FirstOrderForm {
  Eigen::MatrixXd V;          ///< f×f, VᵀMV = 1
  Eigen::Index num_free = 0;  ///< modes that nothing holds
  Eigen::VectorXd scale;      ///< σ of the others [rad/s], f − num_free
  Eigen::MatrixXd A;          ///< s×s, s = 2f − num_free

  Eigen::Index num_bound() const { return scale.size(); }
  /// The y of states that vary as e^{st}. @param states  s×k  @param s  not 0   @return f×k
  Eigen::MatrixXcd calc_amplitudes(const Eigen::MatrixXcd& states, std::complex<double> s) const;
};

/// @param mass  f×f, symmetric positive definite   @param damping, stiffness  f×f   @param rounding  of the
/// stiffness, f×f, ≥ 0
/// @throws support::NumericalError if the mass is not positive definite
FirstOrderForm make_first_order_form(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                     const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& rounding);

/// What real parts of eigenvalues may amount to by rounding alone [1/s].
double calc_eigenvalue_rounding(const Eigen::VectorXcd& eigenvalues);

/// Whether a motion grows: the test of stability, of the eigenvalues of A.
bool has_growth(const Eigen::VectorXcd& eigenvalues);

}  // namespace sprung::dynamics
