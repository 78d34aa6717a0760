#pragma once

#include <Eigen/SparseCore>

#include "fem/mass_moments.h"
#include "reduce/matrices/matrix_body.h"

namespace sprung::reduce {

/// The mass moments of a body from its mass matrix and the places of its nodes (reduce/matrices, eqs. 5–7):
/// mass, first and second moments and momenta exactly; the split of products by directions exactly where
/// displacements along x and y are interpolated alike and rotations apart from them, else to the second order
/// of the size of the elements.
///
/// @param origin  of the body frame [m]
/// Checked by tests/reduce/matrices/matrices_test.py
fem::MassMoments calc_mass_moments(const MatrixBody& body, const Eigen::Vector2d& origin);

/// The mass weighted with the mean x of the two nodes of each entry, in place of ∫x φᵀφ dm (reduce, eq. 9).
Eigen::SparseMatrix<double> calc_distance_weighted_mass(const MatrixBody& body,
                                                        const Eigen::Vector2d& origin);

}  // namespace sprung::reduce
