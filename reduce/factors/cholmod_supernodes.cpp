#include <cholmod.h>

#include <memory>

#include "reduce/factors/supernodes.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

// CHOLMOD's parameters, workspace and status.
class CholmodCommon {
 public:
  CholmodCommon() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_METIS;
    common_.postorder = 1;
    common_.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~CholmodCommon() { cholmod_finish(&common_); }
  CholmodCommon(const CholmodCommon&) = delete;
  CholmodCommon& operator=(const CholmodCommon&) = delete;
  cholmod_common* get() { return &common_; }

 private:
  cholmod_common common_ = {};
};

// The pattern of the lower triangle, whose columns begin at `starts`.
struct LowerPattern {
  std::vector<int> starts, rows;
};

LowerPattern find_lower_pattern(const SparseMatrix& matrix) {
  LowerPattern lower;
  lower.rows.reserve(static_cast<std::size_t>((matrix.nonZeros() + matrix.rows()) / 2 + 1));
  for (int j = 0; j < static_cast<int>(matrix.cols()); ++j) {
    lower.starts.push_back(static_cast<int>(lower.rows.size()));
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      if (entry.row() >= j) lower.rows.push_back(static_cast<int>(entry.row()));
    }
  }
  lower.starts.push_back(static_cast<int>(lower.rows.size()));
  return lower;
}

std::vector<int> copy(const void* numbers, std::size_t count) {
  const int* begin = static_cast<const int*>(numbers);
  return {begin, begin + count};
}

}  // namespace

bool has_cholmod() {
  return true;
}

Supernodes find_supernodes(const SparseMatrix& matrix) {
  LowerPattern lower = find_lower_pattern(matrix);
  cholmod_sparse given = {};
  given.nrow = given.ncol = static_cast<std::size_t>(matrix.rows());
  given.nzmax = lower.rows.size();
  given.p = lower.starts.data();
  given.i = lower.rows.data();
  given.stype = -1;
  given.itype = CHOLMOD_INT;
  given.xtype = CHOLMOD_PATTERN;
  given.sorted = given.packed = 1;
  CholmodCommon common;
  const auto free_factor = [&](cholmod_factor* factor) { cholmod_free_factor(&factor, common.get()); };
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(cholmod_analyze(&given, common.get()),
                                                                      free_factor);
  if (factor == nullptr) {
    const int status = common.get()->status;
    throw support::NumericalError(
        status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE
            ? "factors of the stiffness matrix: the memory does not suffice; refine the mesh less"
            : "factors of the stiffness matrix: CHOLMOD failed");
  }
  return {.order = copy(factor->Perm, factor->n),
          .first = copy(factor->super, factor->nsuper + 1),
          .rows_begin = copy(factor->pi, factor->nsuper + 1),
          .rows = copy(factor->s, factor->ssize)};
}

}  // namespace sprung::reduce
