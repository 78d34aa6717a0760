#pragma once

#include "reduce/factors/supernodes.h"

namespace sprung::reduce {

/// Factors by elimination of one supernode after the other in dense matrices [Duff & Reid 1983]. D has no
/// blocks: nothing is exchanged for the sake of the pivots.
/// @param matrix, is_definite  as make_sparse_factor; the matrix has no entries outside the supernodes
/// @return null as make_sparse_factor
/// @throws support::NumericalError if the memory does not suffice
/// Checked by tests/reduce/factors/sparse_factor_test.cpp
std::unique_ptr<SparseFactor> make_supernodal_factor(const SparseMatrix& matrix, bool is_definite,
                                                     Supernodes supernodes);

}  // namespace sprung::reduce
