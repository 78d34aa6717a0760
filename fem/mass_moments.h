#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "fem/beam_model.h"

namespace sprung::fem {

/// Integrals over a frame's mass that describe its inertia in large motion (fem, eqs. 16–20).
///
/// (x, y) is a material point's position relative to the origin, in the mesh's axes, linear along each
/// element; N_x, N_y, N_ψ are the rows (1×3N) that give its displacement and its section's rotation from the
/// nodal dofs. Translation and rotary inertia are kept apart: rotary inertia ρI and the inertias of point
/// masses enter with N_ψ only.
struct MassMoments {
  double mass = 0.0;                                       ///< ∫dm [kg]
  Eigen::Vector2d first_moment = Eigen::Vector2d::Zero();  ///< ∫(x, y) dm [kg·m]
  double xx = 0.0;                                         ///< ∫x² dm [kg·m²]
  double xy = 0.0;                                         ///< ∫x y dm [kg·m²]
  double yy = 0.0;                                         ///< ∫y² dm [kg·m²]
  double rotary = 0.0;                                     ///< ∫ρI ds + Σ inertias [kg·m²]

  // 3N each; entries at displacements in kg (kg·m with a factor x or y), at rotations one metre more.
  Eigen::VectorXd N_x, N_y;  ///< ∫N_x dm, ∫N_y dm: at a node's x, y the mass lumped there
  Eigen::VectorXd x_N_x, x_N_y, y_N_x, y_N_y;  ///< ∫x N_x dm …
  Eigen::VectorXd rotary_N;                    ///< ∫ρI N_ψ ds + Σ inertias · N_ψ

  // 3N×3N each; NxNx + NyNy + rotary_NN is the consistent mass.
  Eigen::SparseMatrix<double> NxNx;       ///< ∫N_xᵀ N_x dm, symmetric
  Eigen::SparseMatrix<double> NxNy;       ///< ∫N_xᵀ N_y dm, not symmetric
  Eigen::SparseMatrix<double> NyNy;       ///< ∫N_yᵀ N_y dm, symmetric
  Eigen::SparseMatrix<double> rotary_NN;  ///< ∫ρI N_ψᵀ N_ψ ds + Σ inertias, symmetric

  /// Moment of inertia about the origin: xx + yy + rotary [kg·m²].
  double second_moment() const { return xx + yy + rotary; }
};

/// The moments of the elements, by Gauss quadrature that is exact for their shape functions, and of the point
/// masses. Where nodes follow others, the integrals with shape functions have zeros there, and the others'
/// parts.
///
/// @param origin  of the body frame, whose axes are the mesh's [m]
/// @throws std::invalid_argument if the model is not consistent (check_beam_model) or origin not finite
/// Checked by tests/fem/mass_moments_test.cpp
MassMoments calc_mass_moments(const BeamModel& model, const Eigen::Vector2d& origin);

}  // namespace sprung::fem
