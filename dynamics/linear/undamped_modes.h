#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace sprung::dynamics {

/// Rounding error of a product of matrices or of a sum of forces, relative to the sum of the sizes of its
/// terms.
inline constexpr double kRoundingUnit = 100.0 * std::numeric_limits<double>::epsilon();

/// Undamped modes K x = ω² M x, of the symmetric part of K: f freedoms.
struct UndampedModes {
  Eigen::VectorXd omega_squared;  ///< ascending [rad²/s²]
  Eigen::MatrixXd vectors;        ///< f×f, xᵀMx = 1
  Eigen::VectorXd rounding;       ///< of each ω² (linear, eq. 8)

  /// Whether mode k is free: its stiffness is not above rounding.
  bool is_free(Eigen::Index k) const { return std::abs(omega_squared[k]) <= rounding[k]; }
};

/// Rounding of a stiffness matrix that is exact to machine precision, f×f.
Eigen::MatrixXd calc_matrix_rounding(const Eigen::MatrixXd& stiffness);

/// The modes from a general solver, improved by Jacobi rotations until each product xᵢᵀKxⱼ is rounding
/// relative to modes i and j. So ω² of a soft mode is as accurate as K allows, however stiff others are.
/// @param stiffness  f×f
/// @param mass       f×f, symmetric positive definite
/// @param rounding   R of K, f×f, ≥ 0
/// @throws support::NumericalError if the mass is not positive definite
/// Source: [Golub & Van Loan 2013], §8.5 (Jacobi's method) — checked by
/// tests/dynamics/linear/undamped_modes_test.cpp
UndampedModes calc_undamped_modes(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                                  const Eigen::MatrixXd& rounding);

}  // namespace sprung::dynamics
