#pragma once

#include <span>
#include <vector>

#include "dynamics/linear_algebra/pivot_order.h"

namespace sprung::dynamics {

/// LU factors of a square sparse matrix whose values change while its pattern stays. The products of the
/// elimination are listed once. After that, factorising and solving are plain loops over contiguous storage,
/// whose work grows with the entries of the factors.
///
/// Pivots are chosen for the first values, and again when one of them has become small compared with its
/// first size. Source: [Duff, Erisman & Reid 2017], §10.2
class SparseLu {
 public:
  /// @param entries  the pattern; the values of entries at one position are added
  SparseLu(int size, std::vector<MatrixPosition> entries);

  int size() const { return size_; }
  /// Allocates memory only when pivots are chosen. A zero pivot gives infinities, which the caller finds in
  /// the solution.
  /// @param values  one for each entry of the pattern, in their order
  void factorise(std::span<const double> values);
  /// x ← A⁻¹ x
  void solve(double* x) const;
  /// x ← A⁻ᵀ x
  void solve_transposed(double* x) const;
  /// Sign and size do not depend on the pivots chosen.
  double determinant() const { return determinant_; }
  int num_factor_entries() const { return static_cast<int>(factors_.size()); }

 private:
  // Elimination of one row and column. factors_ holds the inverse of its pivot, then the upper and then the
  // lower entries, both divided by the pivot.
  struct Step {
    int first;  // of its entries in factors_
    int num_upper, num_lower;
    int row, column;         // in A
    int end_of_forward = 0;  // end of its row of L in forward_
  };
  // An entry of a row of L, to be multiplied by the result of an earlier step.
  struct Product {
    int step, place;
  };

  void choose_pivots(std::span<const double> values);
  void load(std::span<const double> values);
  bool eliminate();

  int size_;
  std::vector<MatrixPosition> entries_;
  std::vector<Step> steps_;
  std::vector<int> places_;  // of A's entries in factors_
  std::vector<int>
      targets_;  // for each pair of a lower and an upper entry: the entry that loses their product
  std::vector<Product> forward_;    // row by row, each up to Step::end_of_forward
  std::vector<int> upper_columns_;  // for the upper entries of all steps: the step of each one's column
  std::vector<double> factors_;
  std::vector<double> first_pivots_;  // sizes when they were chosen
  double permutation_sign_ = 1.0;
  double determinant_ = 1.0;
  mutable std::vector<double> work_;
};

}  // namespace sprung::dynamics
