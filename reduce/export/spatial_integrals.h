#pragma once

#include <Eigen/Core>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

// Integrals of a body in the plane z = 0 as programs for motion in space have them (reduce/export, eqs. 3, 5,
// 13).

/// v~ with v~ w = v × w.
Eigen::Matrix3d make_cross_matrix(const Eigen::Vector3d& v);

/// About the body frame's origin [kg·m²]. A body in the plane does not know its moments about x and y: each
/// is half of that about z.
Eigen::Matrix3d calc_inertia_tensor(const InertiaInvariants& inertia);

/// ∫((r·φ_k) I − φ_k rᵀ) dm of mode k, which is −∫r~ φ_k~ dm.
Eigen::Matrix3d calc_linear_products(const InertiaInvariants& inertia, Eigen::Index k);

/// ∫((φ_i·φ_j) I − φ_j φ_iᵀ) dm of two modes, which is −∫φ_i~ φ_j~ dm.
Eigen::Matrix3d calc_quadratic_products(const InertiaInvariants& inertia, Eigen::Index i, Eigen::Index j);

// x, y, z of all nodes, one below the other.
Eigen::VectorXd expand_positions(const Superelement& superelement);      ///< 3N [m]
Eigen::MatrixXd expand_displacements(const Superelement& superelement);  ///< 3N×n of the shapes
Eigen::MatrixXd expand_rotations(const Superelement& superelement);      ///< 3N×n of the shapes

}  // namespace sprung::reduce
