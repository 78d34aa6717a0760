#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/bodies/stiffening.h"
#include "reduce/superelement/superelement.h"

namespace sprung::dynamics {

/// Whether axial forces in a body change its bending stiffness.
enum class Stiffening { kOff, kOn };

/// A planar floating-frame body with the modes that are active: r = R + A(θ)(u₀ + Φη), coordinates (R, θ, η).
/// A rigid body has no modes. All values are in the body frame; n active modes.
struct Body {
  std::string name;
  int first_coordinate = 0;       ///< of the body's 3 + n in q
  std::vector<int> mode_numbers;  ///< 1-based numbers of the active modes in the superelement, ascending
  int num_available_modes = 0;    ///< of its superelement; 0 without one

  double mass = 0.0;                                       ///< [kg]
  Eigen::Vector2d first_moment = Eigen::Vector2d::Zero();  ///< S₀ = ∫r dm [kg·m]
  double second_moment = 0.0;  ///< J₀ = ∫(x² + y²) dm about the frame's origin [kg·m²]
  Eigen::Matrix2Xd P;          ///< ∫φ dm, 2×n
  Eigen::RowVectorXd c;        ///< ∫(x φ_y − y φ_x) dm, 1×n
  Eigen::RowVectorXd d;        ///< ∫(x φ_x + y φ_y) dm, 1×n
  Eigen::MatrixXd M_ff;        ///< ∫φᵀφ dm with rotary inertia, n×n
  /// Mass of each mode where the body is free: with it, damping 2 ζ ω m is that of the ratio ζ. 1 for modes
  /// of the free body, the diagonal of M_ff for clamped ones. n
  Eigen::VectorXd modal_mass;
  Eigen::MatrixXd M_tt;        ///< the translational part of M_ff, n×n
  Eigen::MatrixXd B;           ///< ∫(φ_xᵀφ_y − φ_yᵀφ_x) dm, n×n, skew
  Eigen::MatrixXd stiffness;   ///< n×n
  Eigen::MatrixXd damping;     ///< n×n
  Eigen::VectorXd mode_scale;  ///< n, largest displacement of any node per unit modal coordinate [m]
  /// For a rigid body without mass or without inertia: what stands in their place while accelerations are
  /// found, small beside all others of the system (system, eq. 13). The equations of motion do not contain
  /// them.
  double stand_in_mass = 0.0;     ///< [kg]
  double stand_in_inertia = 0.0;  ///< [kg·m²]
  /// Least entries of the metric of the coordinates x, y, ψ (system, eq. 3) [kg, kg, kg·m²].
  Eigen::Vector3d least_metric = Eigen::Vector3d::Zero();
  std::optional<BodyStiffening> stiffening;  ///< present where it is switched on and there are modes

  int num_modes() const { return static_cast<int>(mode_numbers.size()); }
  int num_coordinates() const { return 3 + num_modes(); }
};

/// A rigid body whose frame is at its centre of mass.
/// @param mass     ≥ 0 [kg]
/// @param inertia  ≥ 0, about the centre of mass [kg·m²]
/// @throws std::invalid_argument if one of them is negative
/// Checked by tests/dynamics/bodies/body_test.cpp
Body make_rigid_body(const std::string& name, double mass, double inertia);

/// A body from a superelement with the given modes active. Without modes it is rigid, with the same mass and
/// inertia.
/// @param mode_numbers   1-based, ascending, without repetition, at most superelement.num_modes()
/// @throws std::invalid_argument for a mode that the superelement lacks; with stiffening, for a mode whose
///         geometric stiffness it lacks
/// Checked by tests/dynamics/bodies/body_test.cpp
Body make_flexible_body(const std::string& name, const reduce::Superelement& superelement,
                        const std::vector<int>& mode_numbers, Stiffening stiffening = Stiffening::kOff);

}  // namespace sprung::dynamics
