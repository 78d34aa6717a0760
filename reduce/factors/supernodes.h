#pragma once

#include <vector>

#include "reduce/factors/sparse_factor.h"

namespace sprung::reduce {

/// Where the factor L of a sparse symmetric matrix A = Pᵀ L D Lᵀ P has entries: in supernodes, groups of
/// neighbouring columns that have their rows in common. They come children first: all below a supernode in
/// the tree of elimination stand directly before it.
struct Supernodes {
  std::vector<int> order;       ///< P: the unknowns in the order of elimination, n
  std::vector<int> first;       ///< first column of each supernode, and n
  std::vector<int> rows_begin;  ///< where in `rows` those of each supernode begin, and the end
  std::vector<int> rows;        ///< rows of each supernode in ascending order, beginning with its own columns

  std::size_t size() const { return first.size() - 1; }
};

/// Finds an order of elimination by METIS, and the supernodes of it. Without CHOLMOD it is never called
/// (has_cholmod).
/// @param matrix  n×n, symmetric
/// @throws support::NumericalError if the memory does not suffice
/// Source: [Chen et al. 2008]
Supernodes find_supernodes(const SparseMatrix& matrix);

}  // namespace sprung::reduce
