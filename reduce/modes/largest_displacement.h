#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// The freedom in which a set of modes moves most, chosen without regard to node order or to the basis of the
/// set.
///
/// A freedom's size is the norm of its row of `shapes`; rotations are weighed with the radius of the body. Of
/// the freedoms within 1 % of the largest it is the one at the largest x, then the largest y, then y before x
/// before rotation.
///
/// @param shapes          3N×k, k ≥ 1
/// @param node_positions  2×N, from the reference node [m]
/// @return row of `shapes`, 0-based
/// Checked by tests/reduce/modes/canonical_basis_test.cpp
Eigen::Index find_largest_displacement(const Eigen::MatrixXd& shapes, const Eigen::Matrix2Xd& node_positions);

}  // namespace sprung::reduce
