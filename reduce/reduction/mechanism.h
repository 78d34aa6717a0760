#pragma once

#include "reduce/design/design.h"
#include "reduce/modes/eigen_pairs.h"

namespace sprung::reduce {

/// Refuses a body of which a mode is lost in rounding: mostly the lowest one, but a fine mesh of a light part
/// may spoil that part's modes only. Where nearly all of the mode's strain energy is in one element, the
/// frame gives way there with almost no force, and the message names that element: it is an internal
/// mechanism.
///
/// @param stiffness  n×n, of the held frame   @param modes  k ≥ 1
/// @return the largest relative rounding error of the modes' ω² (estimate_rounding_error)
/// @throws support::NumericalError if it is above kMaxRoundingError
/// Checked by tests/reduce/reduction/mechanism_test.cpp
double check_rounding(const Design& design, const Eigen::SparseMatrix<double>& stiffness,
                      const EigenPairs& modes);

}  // namespace sprung::reduce
