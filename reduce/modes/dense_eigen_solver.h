#pragma once

#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

/// All solutions of K φ = ω² M φ by the flipped problem M φ = μ K φ, μ = 1/ω².
///
/// With K = L Lᵀ and M = G Gᵀ the singular values of L⁻¹G are 1/ω and its right singular vectors v give φ =
/// G⁻ᵀ v (reduce, eqs. 3–5). Working with ω instead of ω² keeps the high modes as good as the low
/// ones, and low frequencies do not depend on the numbering of the nodes beyond rounding. Freedoms whose row
/// of M is zero follow the others; there are fewer solutions by as many. Where other motions have no mass
/// either, high modes are less exact: φ = ω² K⁻¹ G v.
///
/// Costs about 20 n³ operations and 5 n² values.
///
/// @param num_missing  M has this rank less than rows: the number of its zero rows, or more
/// @throws support::NumericalError if K is not positive definite to rounding, or M has another rank
/// Source: [Golub & Van Loan 2013], §8.7.4 — checked by tests/reduce/modes/clamped_modes_test.cpp
EigenPairs solve_dense(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass,
                       Eigen::Index num_missing = 0);

}  // namespace sprung::reduce
