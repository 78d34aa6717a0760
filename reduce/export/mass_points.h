#pragma once

#include <Eigen/Core>

#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Points that have the integrals of a body in plane motion as sums: masses that are displaced, and moments
/// of inertia that turn.
struct MassPoints {
  Eigen::VectorXd mass;       ///< N, all equal [kg]
  Eigen::Matrix2Xd position;  ///< 2×N, in the body frame [m]
  Eigen::MatrixXd shape_x;    ///< N×n, per unit modal coordinate
  Eigen::MatrixXd shape_y;    ///< N×n
  Eigen::VectorXd inertia;    ///< K, all equal [kg·m²]; none without rotary inertia
  Eigen::MatrixXd rotation;   ///< K×n, per unit modal coordinate
};

/// The sums over the points are m, S₀, J₀, P, c, d, M_ff, M_xx + M_yy and B to rounding, and these are all
/// that motion in the plane needs (reduce/export, eqs. 1–5). The positions are not those of material points.
/// @throws std::domain_error if no masses have these integrals, as of a body from matrices of few elements,
///         whose B is not exact
/// Checked by tests/reduce/export/program_export_test.py
MassPoints find_mass_points(const InertiaInvariants& inertia);

}  // namespace sprung::reduce
