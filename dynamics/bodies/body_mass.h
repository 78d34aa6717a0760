#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "dynamics/bodies/body.h"
#include "dynamics/bodies/body_equations.h"
#include "dynamics/bodies/modal_matrix.h"

namespace sprung::dynamics {

/// The mass matrix of a body, factorised by blocks. M_ff never changes, so only a 3×3 matrix is factorised at
/// each state, whatever the number of modes:
///
///     M = [M_r H; Hᵀ M_ff],   C = M_r − H M_ff⁻¹ Hᵀ                                  (bodies, eq. 6)
class BodyMass {
 public:
  explicit BodyMass(const Body& body);

  /// Mass matrix and factors at a state (bodies, eqs. 3, 6). @param eta  n
  /// Source: [Shabana 2013], §5.4, with the invariants of the superelement — checked by
  /// tests/dynamics/bodies/body_equations_test.cpp and body_mass_test.cpp
  void update(const FrameRotation& rotation, const Eigen::Ref<const Eigen::VectorXd>& eta);
  const Eigen::MatrixXd& matrix() const { return M_; }  ///< (3+n)×(3+n)
  /// First moment of mass about the frame's origin, S₀ + P η, body axes [kg·m].
  const Eigen::Vector2d& first_moment() const { return first_moment_; }
  const Eigen::VectorXd& M_tt_eta() const { return M_tt_eta_; }  ///< n

  /// Whether the body is rigid with its frame at the centre of mass. Its mass matrix is then diagonal and
  /// constant, and neither weight nor rotation causes a torque.
  bool is_constant() const { return constant_; }

  /// Diagonal entry of the metric: of M, but not below the body's least one.
  double metric(int coordinate) const {
    const double mass = M_(coordinate, coordinate);
    return coordinate < 3 ? std::max(mass, body_->least_metric[coordinate]) : mass;
  }

  /// x ← M⁻¹ x, with the stand-ins added to M where the body has no mass or no inertia.
  /// @param x  3+n values
  void solve(double* x) const {
    if (constant_) {
      for (int i = 0; i < 3; ++i) x[i] *= C_inverse_(i, i);
    } else {
      solve_coupled(x);
    }
  }

  /// Prepares two rows G of a Jacobian for products G₁ M⁻¹ G₂ᵀ = U₁ V₂ᵀ: with Y = G_r − G_f M_ff⁻¹ Hᵀ,
  ///
  ///     U = (Y, G_f),   V = (Y C⁻¹, G_f M_ff⁻¹)
  ///
  /// @param upper, lower  3+n values each, the rows
  /// @param U, V          3+n columns each, written
  void reduce_rows(const double* upper, const double* lower, Eigen::Vector2d* U, Eigen::Vector2d* V) const {
    for (int i = 0; i < 3; ++i) U[i] = {upper[i], lower[i]};
    if (constant_) {
      for (int i = 0; i < 3; ++i) V[i] = C_inverse_(i, i) * U[i];
      return;
    }
    if (W_.cols() > 0) reduce_modal_part(upper + 3, lower + 3, U, V);
    for (int i = 0; i < 3; ++i)
      V[i] = U[0] * C_inverse_(0, i) + U[1] * C_inverse_(1, i) + U[2] * C_inverse_(2, i);
  }

 private:
  void update_matrix(const FrameRotation& rotation, const double* eta);
  void solve_coupled(double* x) const;
  // Multiplies rows of modal values by M_ff⁻¹. @param values  num_rows×n
  template <int num_rows>
  void multiply_inverse(double* values) const;
  void reduce_modal_part(const double* upper, const double* lower, Eigen::Vector2d* U,
                         Eigen::Vector2d* V) const;

  const Body* body_;
  bool constant_;
  Eigen::Vector3d stand_in_;
  ModalMatrix M_tt_, B_;
  Eigen::Vector2d first_moment_;
  Eigen::VectorXd M_tt_eta_, B_eta_;
  bool diagonal_;  // M_ff is diagonal to rounding
  Eigen::VectorXd diagonal_inverse_;
  Eigen::MatrixXd inverse_factor_;  // G of M_ff⁻¹ = I − G Gᵀ, n×r: where M_ff is I and a part of rank r ≤ 3
  Eigen::MatrixXd M_ff_inverse_;  // used where it is neither
  Eigen::MatrixXd M_;
  Eigen::Matrix3Xd W_;  // H M_ff⁻¹
  Eigen::Matrix3d C_inverse_;
  mutable Eigen::VectorXd modal_work_;
};

}  // namespace sprung::dynamics
