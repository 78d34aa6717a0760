#include "reduce/modes/stiffness_factor.h"

namespace sprung::reduce {

StiffnessFactor::StiffnessFactor(const SparseMatrix& stiffness)
    : factor_(make_sparse_factor(stiffness, true)) {
  if (factor_ != nullptr) return;
  throw IndefiniteStiffness(
      "the stiffness matrix is not positive definite to rounding: a part of the frame moves without any "
      "force (an internal mechanism), the mesh is too fine, or sections differ by many orders of magnitude");
}

}  // namespace sprung::reduce
