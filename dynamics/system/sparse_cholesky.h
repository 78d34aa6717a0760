#pragma once

#include <utility>
#include <vector>

namespace sprung::dynamics {

/// Factors L D Lᵀ of a symmetric positive definite sparse matrix whose pattern stays and whose values come
/// again and again. The order of elimination (minimum degree) and the places of all products are found once;
/// factorising and solving are plain loops that ask for no memory, their work grows with the entries of L.
/// Source: [Duff, Erisman & Reid 2017], §§7.3, 11.2
class SparseCholesky {
 public:
  SparseCholesky() = default;
  /// @param entries  (row, column) of the pattern, either triangle or both; the diagonal is in it anyway
  SparseCholesky(int size, const std::vector<std::pair<int, int>>& entries);

  /// Where the value of an entry of the pattern goes in `values`; the same for (j, i) as for (i, j).
  int place(int i, int j) const;
  /// A place in `values` that nothing reads.
  int unused_place() const { return static_cast<int>(rows_.size()); }
  /// Fill before `factorise`, which writes the factors over it. Zero where nothing was filled in.
  std::vector<double>& values() { return values_; }

  /// @return false where the matrix is not positive definite
  bool factorise();
  /// x ← A⁻¹ x
  void solve(double* x) const;
  int num_factor_entries() const { return static_cast<int>(rows_.size()); }

 private:
  int size_ = 0;
  std::vector<int> order_, step_;  // rows in the order in which they are eliminated; the inverse
  std::vector<int> first_;    // of each step's entries in values_: the diagonal, then those below; size_ + 1
  std::vector<int> rows_;     // beside values_: steps, ascending in a column
  std::vector<int> targets_;  // for all pairs of entries below a diagonal: what their product is taken from
  std::vector<double> values_;
  mutable std::vector<double> work_;
};

}  // namespace sprung::dynamics
