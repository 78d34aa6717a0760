#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

#include "reduce/modes/free_body.h"

namespace sprung::reduce {

/// A participation counts where it is at least this share of its scale, √m for the translations and √J₀ for
/// the rotation: one millionth of the body's mass or inertia. What is smaller could not fix a direction to
/// 1e-10, the vectors being good to 1e-13.
inline constexpr double kParticipationThreshold = 1e-3;

/// What the canonical basis is made from. Body axes, origin at the reference node.
struct BasisFrame {
  Eigen::Matrix2Xd node_positions;  ///< 2×N [m]
  double mass = 0.0;                ///< m [kg]
  double second_moment = 0.0;       ///< J₀ [kg·m²]
  Eigen::MatrixXd participation_rows;  ///< 3×3N: ∫φ_y dm, ∫φ_x dm, ∫(x φ_y − y φ_x) dm with rotary inertia
  /// 3N×3N, as from calc_distance_weighted_mass. Few clusters ask for it.
  std::function<Eigen::SparseMatrix<double>()> make_weighted_mass;
};

/// @param node_positions     2×N, from the reference node [m]
/// @param make_weighted_mass  about the reference node
BasisFrame make_basis_frame(const RigidMotions& rigid, const Eigen::Matrix2Xd& node_positions,
                            std::function<Eigen::SparseMatrix<double>()> make_weighted_mass);

/// The rotation, with signs, that makes a basis of the modes depend on neither solver, seed nor node order
/// (reduce, "One basis"). Modes of different clusters are not mixed. Within a cluster:
///
/// 1. The participation in translation along y, then x, then in rotation about the reference is given to
///    one member each, if it is at least kParticipationThreshold of its scale; the members after it have
///    none.
/// 2. The others are the eigenvectors of ∫x φᵀφ dm, in ascending order.
/// 3. Where these values are equal, too (to 1e-3 of the body's radius), the direction with the largest
///    displacement becomes a member (of several within 1 % that at the largest x, then y), and so on with the
///    rest.
///
/// Sign: the largest of the three participations (of several within 1 % the first, in the order above) is
/// positive; where all are below the threshold, the largest displacement.
///
/// @param shapes   3N×n, M-orthonormal
/// @param cluster  n, as from find_clusters
/// @return n×n, orthogonal, block diagonal: the canonical modes are shapes · result
/// Checked by tests/reduce/modes/canonical_basis_test.cpp
Eigen::MatrixXd calc_canonical_rotation(const Eigen::MatrixXd& shapes, const Eigen::VectorXi& cluster,
                                        const BasisFrame& frame);

}  // namespace sprung::reduce
