#include "reduce/factors/supernodes.h"

// In place of cholmod_supernodes.cpp where CHOLMOD is not there.
namespace sprung::reduce {

bool has_cholmod() {
  return false;
}

Supernodes find_supernodes(const SparseMatrix& /*matrix*/) {
  return {};
}

}  // namespace sprung::reduce
