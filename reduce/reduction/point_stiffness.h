#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem/beam_model.h"
#include "reduce/factors/tall_products.h"
#include "reduce/modes/stiffness_factor.h"

namespace sprung::reduce {

/// Geometric stiffness of modes under a force of 1 N along x, along y [1/(kg·m)] and a moment of 1 N·m
/// [1/(kg·m²)] at each named point; n×n each.
using PointStiffness = std::vector<std::array<Eigen::MatrixXd, 3>>;

/// The loads of the points, or the pairs of modes, are solved for, whichever are fewer (reduce, eq. 19).
///
/// @param reference_node  0-based, held
/// @param factor          of K without the reference node's freedoms
/// @param shapes          3N×n
/// Checked by tests/reduce/reduction/reference_stiffness_test.cpp
PointStiffness calc_point_stiffness(const fem::BeamModel& model, int reference_node,
                                    const StiffnessFactor& factor, const TallMatrix& shapes);

}  // namespace sprung::reduce
