#pragma once

#include <Eigen/Core>

#include "dynamics/bodies/body.h"
#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

/// The mass matrix of a body, factorised by its blocks. M_ff never changes, so only a 3×3 matrix is left to be
/// factorised at each state, whatever the number of modes:
///
///     M = [M_r H; Hᵀ M_ff],   C = M_r − H M_ff⁻¹ Hᵀ                                  (dynamics/README.md, eq. 17)
class BodyMass {
 public:
  explicit BodyMass(const Body& body);

  /// Mass matrix and factors at a state. @param eta  n
  void update(const FrameRotation& rotation, const Eigen::Ref<const Eigen::VectorXd>& eta);
  const Eigen::MatrixXd& matrix() const { return M_; }  ///< (3+n)×(3+n)

  /// A rigid body about its centre of mass: its mass matrix is diagonal and always the same, and neither its weight
  /// nor its turning make a torque.
  bool is_constant() const { return constant_; }

  /// x ← M⁻¹ x.  @param x  3+n values
  void solve(double* x) const {
    if (constant_) {
      for (int i = 0; i < 3; ++i) x[i] *= C_inverse_(i, i);
    } else {
      solve_coupled(x);
    }
  }

  /// A row G of a Jacobian made ready for products G₁ M⁻¹ G₂ᵀ = U₁ V₂ᵀ: with Y = G_r − G_f M_ff⁻¹ Hᵀ,
  ///
  ///     U = (Y, G_f),   V = (Y C⁻¹, G_f M_ff⁻¹)
  ///
  /// @param G     3+n values
  /// @param U, V  3+n values each at every other place, written
  void reduce_row(const double* G, double* U, double* V) const {
    double y[3] = {G[0], G[1], G[2]};
    if (W_.cols() > 0) reduce_modal_part(G + 3, y, U + 6, V + 6);
    for (int i = 0; i < 3; ++i) {
      U[2 * i] = y[i];
      V[2 * i] = C_inverse_(i, 0) * y[0] + C_inverse_(i, 1) * y[1] + C_inverse_(i, 2) * y[2];
    }
  }

 private:
  void solve_coupled(double* x) const;
  void reduce_modal_part(const double* G_f, double* y, double* U, double* V) const;

  const Body* body_;
  bool constant_;
  bool diagonal_;  // M_ff is diagonal to rounding
  Eigen::VectorXd diagonal_inverse_;
  Eigen::MatrixXd M_ff_inverse_;  // used where it is not
  Eigen::MatrixXd M_;
  Eigen::Matrix3Xd W_;  // H M_ff⁻¹
  Eigen::Matrix3d C_inverse_;
  mutable Eigen::VectorXd modal_work_;
};

}  // namespace sprung::dynamics
