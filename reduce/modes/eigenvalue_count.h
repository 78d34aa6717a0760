#pragma once

#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

/// Number of modes with ω² below a shift σ: the negative entries of D in K − σ M = L D Lᵀ, by Sylvester's law
/// of inertia (reduce, eq. 6). It needs no eigenvalue solver, and counts a repeated
/// eigenvalue as often as it occurs. Of a free frame the elastic modes are counted.
///
/// @param omega_squared  σ ≥ 0, of a free frame > 0 [rad²/s²]
/// @throws support::NumericalError if the factors do not reproduce K − σ M (σ too near an eigenvalue)
/// Source: [Parlett 1998], §3.3 — checked by tests/reduce/modes/clamped_modes_test.cpp
int count_modes_below(const ModalProblem& problem, double omega_squared);

}  // namespace sprung::reduce
