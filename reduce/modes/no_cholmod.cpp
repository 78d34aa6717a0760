#include "reduce/modes/cholmod_factor.h"

// In place of cholmod_factor.cpp where CHOLMOD is not there.
namespace sprung::reduce {

bool has_cholmod() {
  return false;
}

std::unique_ptr<SparseFactor> make_cholmod_factor(const SparseMatrix& /*matrix*/, bool /*is_definite*/,
                                                  std::span<const int> /*order*/) {
  return nullptr;
}

}  // namespace sprung::reduce
