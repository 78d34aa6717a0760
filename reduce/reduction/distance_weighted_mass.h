#pragma once

#include <Eigen/SparseCore>

#include "fem/beam_model.h"

namespace sprung::reduce {

/// The consistent mass of translation weighted with x, ∫x (N_xᵀN_x + N_yᵀN_y) dm (reduce, eq. 9):
/// its projection on a mode says on which side of the origin the mode moves.
///
/// @param origin  where x is 0, in the mesh's axes [m]
/// @return 3N×3N, symmetric, dof order of fem::assemble [kg·m; rotations kg·m², kg·m³]
/// @throws std::invalid_argument if the model is not consistent (fem::check_beam_model)
/// Checked by tests/reduce/modes/canonical_basis_test.cpp
Eigen::SparseMatrix<double> calc_distance_weighted_mass(const fem::BeamModel& model,
                                                        const Eigen::Vector2d& origin);

}  // namespace sprung::reduce
