#pragma once

#include "fem/beam_model.h"
#include "fem/mass_moments.h"
#include "reduce/modes/stiffness_factor.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Largest number of modes that get a geometric stiffness, because it takes three matrices for each point. Of
/// a body with more modes they are the lowest.
inline constexpr int kMaxStiffenedModes = 200;

/// Geometric stiffness of modes under the reference loads (reduce, eqs. 19–22). For each load the frame held
/// at its reference node is solved for its axial forces; their geometric stiffness is assembled and projected
/// on the modes.
///
/// @param reference_node  0-based; the body frame's origin
/// @param factor          of K without the reference node's freedoms
/// @param moments         about the reference node
/// @param shapes          3N×n
/// Source: [Wallrapp & Schwertassek 1991] — checked by tests/reduce/reduction/reference_stiffness_test.cpp
GeometricStiffness calc_reference_stiffness(const fem::BeamModel& model, int reference_node,
                                            const StiffnessFactor& factor, const fem::MassMoments& moments,
                                            const Eigen::MatrixXd& shapes);

}  // namespace sprung::reduce
