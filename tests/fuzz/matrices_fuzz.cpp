// Files of matrices and their tables, in each of their formats: an InputError, or a symmetric matrix of
// finite numbers. Formats that do not name their freedoms get those of two nodes in the plane.
#include <cmath>
#include <cstdlib>
#include <utility>

#include "reduce/matrices/abaqus_matrix.h"
#include "reduce/matrices/calculix_matrix.h"
#include "reduce/matrices/matrix_market.h"
#include "reduce/matrices/nastran_dmig.h"
#include "reduce/matrices/tables.h"
#include "tests/fuzz/memory_file.h"
#include "tools/support/errors/input_error.h"

namespace {

using namespace sprung;

reduce::FreedomList freedoms_of_two_nodes() {
  reduce::FreedomList freedoms;
  for (const int node : {1, 2}) {
    for (const int direction : {1, 2, 6}) freedoms.get({node, direction});
  }
  return freedoms;
}

void expect_symmetric(reduce::MatrixEntries entries, const reduce::FreedomList& freedoms) {
  const Eigen::SparseMatrix<double> matrix = reduce::make_symmetric_matrix(std::move(entries), freedoms);
  if (matrix.rows() != freedoms.size() ||
      !Eigen::SparseMatrix<double>(matrix.transpose()).isApprox(matrix, 0.0))
    std::abort();
  for (Eigen::Index k = 0; k < matrix.nonZeros(); ++k) {
    if (!std::isfinite(matrix.valuePtr()[k])) std::abort();
  }
}

// Refusing an input is a good end.
template <class Reading>
void attempt(const Reading& reading) {
  try {
    reading();
  } catch (const support::InputError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile input(data, size);
  const reduce::FreedomList known = freedoms_of_two_nodes();
  attempt([&] { expect_symmetric(reduce::read_matrix_market(input.path(), known), known); });
  attempt([&] { expect_symmetric(reduce::read_calculix_matrix(input.path(), known), known); });
  for (const bool has_table : {false, true}) {
    attempt([&] {
      reduce::FreedomList freedoms = has_table ? known : reduce::FreedomList();
      reduce::MatrixEntries entries = reduce::read_abaqus_matrix(input.path(), freedoms, has_table);
      expect_symmetric(std::move(entries), freedoms);
    });
  }
  for (const char* const name : {"", "KAAX"}) {
    attempt([&] {
      reduce::FreedomList freedoms;
      reduce::MatrixEntries entries = reduce::read_nastran_dmig(input.path(), name, freedoms);
      expect_symmetric(std::move(entries), freedoms);
    });
  }
  attempt([&] { reduce::read_freedom_table(input.path()); });
  attempt([&] { reduce::read_calculix_freedoms(input.path()); });
  attempt([&] {
    if (!reduce::read_node_table(input.path()).positions.allFinite()) std::abort();
  });
  return 0;
}
