#pragma once

#include "reduce/modes/sparse_factor.h"

namespace sprung::reduce {

/// Factors by CHOLMOD. Without CHOLMOD it is never called (has_cholmod).
/// @param matrix, is_definite, order  as make_sparse_factor
/// @throws support::NumericalError if the memory does not suffice
/// Source: [Chen et al. 2008]
std::unique_ptr<SparseFactor> make_cholmod_factor(const SparseMatrix& matrix, bool is_definite,
                                                  std::span<const int> order);

}  // namespace sprung::reduce
