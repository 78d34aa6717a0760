#pragma once

#include <cstdint>

#include "reduce/modes/eigen_pairs.h"
#include "reduce/modes/stiffness_factor.h"

namespace sprung::reduce {

/// The lowest solutions of K φ = ω² M φ by Lanczos iteration with the inverse of K (shift 0), polished by one
/// step of subspace iteration.
///
/// The solutions are accurate, but *not necessarily the lowest ones*: the iteration can miss members of
/// repeated frequencies without an error. Count them (eigenvalue_count.h).
///
/// @param num_pairs  1 … n−1
/// @param seed       of the random start vector
/// @throws support::NumericalError if K cannot be factored or the iteration does not converge
///         std::invalid_argument if num_pairs is out of range
/// Checked by tests/reduce/modes/clamped_modes_test.cpp
EigenPairs solve_sparse(const ModalProblem& problem, int num_pairs, std::uint64_t seed);

/// The same by Spectra's iteration, which has restarts, whatever the size. @param factor  of K
EigenPairs solve_by_restarts(const ModalProblem& problem, const StiffnessFactor& factor, int num_pairs,
                             std::uint64_t seed);

/// All solutions below a value of ω² that the iteration meets, and some beyond, of which the ω² alone is
/// exact. For large frames, where counting them beforehand costs a factorisation.
EigenPairs solve_sparse_below(const ModalProblem& problem, double omega_squared, std::uint64_t seed);

}  // namespace sprung::reduce
