#pragma once

#include "reduce/design/design.h"
#include "reduce/modes/eigen_pairs.h"
#include "reduce/reduction/body_basis.h"

namespace sprung::reduce {

/// Refuses a body of which a mode is lost in rounding: mostly the lowest one, but a fine mesh of a light part
/// may spoil that part's modes only. Where nearly all of the mode's strain energy is in one element, the
/// frame gives way there with almost no force, and the message names that element: it is an internal
/// mechanism.
///
/// @param stiffness  n×n, of the held frame   @param modes  k ≥ 1
/// A mode whose estimated error is too large is judged by the error that rounding really made: with the
/// energy that the relative motions of the elements' ends have in its shape (reduce, eq. 29).
///
/// @return the largest relative rounding error of the modes' ω², estimated (estimate_rounding_error) or
/// measured
/// @throws support::NumericalError if it is above kMaxRoundingError
/// Checked by tests/reduce/reduction/mechanism_test.cpp
double check_rounding(const Design& design, const Eigen::SparseMatrix<double>& stiffness,
                      const EigenPairs& modes);

/// Refuses a body whose held stiffness is not positive definite to rounding. The message names the node and
/// freedom that move most where nothing holds the body, and the element that gives way if it is one alone.
/// Where all of the body moves rigidly, the reference node is the cause.
///
/// @param matrices  all but the factor
/// @param reason    what the factorisation says
/// @throws support::NumericalError
/// Checked by tests/reduce/reduction/mechanism_test.cpp
[[noreturn]] void refuse_indefinite(const Design& design, const BodyMatrices& matrices,
                                    const std::string& reason);

}  // namespace sprung::reduce
