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

  /// x ← M⁻¹ x.  @param x  3+n values
  void solve(double* x) const;

  /// The rows G of a Jacobian that belong to this body, made ready for G₁ M⁻¹ G₂ᵀ = Y₁ C⁻¹ Y₂ᵀ + G_f₁ M_ff⁻¹ G_f₂ᵀ.
  /// @param G  (3+n) values   @param[out] Y  G_r − G_f M_ff⁻¹ Hᵀ   @param[out] Z  n values, G_f M_ff⁻¹
  void reduce_row(const double* G, Eigen::Vector3d& Y, double* Z) const {
    Y = Eigen::Map<const Eigen::Vector3d>(G);
    if (W_.cols() > 0) reduce_modal_part(G + 3, Y, Z);
  }
  /// C⁻¹ y.
  Eigen::Vector3d solve_rigid(const Eigen::Vector3d& y) const { return C_inverse_ * y; }

 private:
  void reduce_modal_part(const double* G_f, Eigen::Vector3d& Y, double* Z) const;

  const Body* body_;
  bool constant_;  // the mass matrix: of a rigid body about its centre of mass
  bool diagonal_;  // M_ff is diagonal to rounding
  Eigen::VectorXd diagonal_inverse_;
  Eigen::MatrixXd M_ff_inverse_;  // used where it is not
  Eigen::MatrixXd M_;
  Eigen::Matrix3Xd W_;  // H M_ff⁻¹
  Eigen::Matrix3d C_inverse_;
  mutable Eigen::VectorXd modal_work_;
};

}  // namespace sprung::dynamics
