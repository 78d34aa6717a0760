#pragma once

#include "fem/mass_moments.h"
#include "reduce/superelement/superelement.h"

namespace sprung::reduce {

/// Projects a frame's mass moments on mode shapes (reduce, eqs. 10–17).
///
/// @param moments  about the body frame's origin
/// @param shapes   3N×n
/// @throws std::invalid_argument if the sizes differ
/// Checked by tests/reduce/reduction/inertia_invariants_test.cpp
InertiaInvariants calc_inertia_invariants(const fem::MassMoments& moments, const Eigen::MatrixXd& shapes);

/// Mass matrix of the undeformed body for motion of its frame (R in body axes, θ) and its modal coordinates
/// (reduce, eq. 18):
///
///     ┌ m I    ⊥S₀   P  ┐
///     │ ⊥S₀ᵀ   J₀    c  │        ⊥S₀ = (−S₀y, S₀x)ᵀ
///     └ Pᵀ     cᵀ    M_ff ┘
///
/// @return (3+n)×(3+n), symmetric, positive definite
Eigen::MatrixXd calc_mass_matrix(const InertiaInvariants& inertia);

}  // namespace sprung::reduce
