#pragma once

#include <cstdint>

#include "reduce/modes/eigen_pairs.h"
#include "reduce/modes/stiffness_factor.h"

namespace sprung::reduce {

/// Which solutions are wanted: the lowest ones or all with ω² below a value, whichever are more, and some
/// beyond those. Of the ones beyond only ω² is exact.
struct WantedPairs {
  int lowest = 0;
  double below = 0.0;  ///< [rad²/s²]
  int beyond = 0;
};

/// The lowest solutions of K φ = ω² M φ by Lanczos iteration with the inverse of K (shift 0) on blocks of
/// vectors, without restarts. Large factors are read from memory once for a block, not once for each of its
/// vectors. Each block is made M-orthogonal to all before.
///
/// The solutions have relative residuals below 1e-12, but are *not necessarily the lowest ones* where more of
/// them have one frequency than a block has vectors. Count them (eigenvalue_count.h).
///
/// Needs about five times as many vectors as pairs.
///
/// @param factor     of K
/// @param num_pairs  1 … n−1
/// @param seed       of the random start block
/// @throws support::NumericalError if it does not converge
/// Source: [Grimes, Lewis & Simon 1994] — checked by tests/reduce/modes/block_lanczos_test.cpp
EigenPairs solve_by_blocks(const ModalProblem& problem, const StiffnessFactor& factor, int num_pairs,
                           std::uint64_t seed);
EigenPairs solve_by_blocks(const ModalProblem& problem, const StiffnessFactor& factor,
                           const WantedPairs& wanted, std::uint64_t seed);

}  // namespace sprung::reduce
