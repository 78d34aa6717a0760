#pragma once

#include <span>
#include <vector>

namespace sprung::dynamics {

/// LU factors of a square sparse matrix whose pattern stays and whose values come again and again: what is
/// eliminated by what is written down once, so that factorising and solving are a few plain loops over
/// contiguous storage. The work grows with the entries of the factors.
///
/// Pivots are chosen for little fill among entries that are not small in their row (Markowitz with
/// threshold), at the first values and again where one of them has become small against what it was. Source:
/// [Duff, Erisman & Reid 2017], §§5.2, 7.2, 10.2
class SparseLu {
 public:
  struct Position {
    int row, column;
  };
  /// @param entries  of the pattern; those at one position add up
  SparseLu(int size, std::vector<Position> entries);

  int size() const { return size_; }
  /// @param values  one for each entry of the pattern, in their order. A zero pivot is left to give
  /// infinities, which the caller finds in its result. Asks for memory only where pivots are chosen.
  void factorise(std::span<const double> values);
  /// x ← A⁻¹ x
  void solve(double* x) const;
  /// Sign and size are right whichever the pivots.
  double determinant() const { return determinant_; }
  int num_factor_entries() const { return static_cast<int>(factors_.size()); }

 private:
  // Elimination of one row and column. factors_ holds its pivot, inverted; then upper, then lower, both
  // divided by it.
  struct Step {
    int first;  // of its entries in factors_
    int num_upper, num_lower;
    int row, column;         // in A
    int end_of_forward = 0;  // of its row of L in forward_
  };
  // What the rows of L take in solving: an entry, times the result of an earlier step.
  struct Product {
    int step, place;
  };
  struct Elimination;

  void choose_pivots(std::span<const double> values);
  void load(std::span<const double> values);
  bool eliminate();

  int size_;
  std::vector<Position> entries_;
  std::vector<Step> steps_;
  std::vector<int> places_;  // of A's entries in factors_
  std::vector<int>
      targets_;  // for every lower entry and every upper one beside it: what their product is taken from
  std::vector<Product> forward_;    // row by row, to Step::end_of_forward
  std::vector<int> upper_columns_;  // beside the upper entries of all steps: the steps of their columns
  std::vector<double> factors_;
  std::vector<double> first_pivots_;  // as they were when they were chosen
  double permutation_sign_ = 1.0;
  double determinant_ = 1.0;
  mutable std::vector<double> work_;
};

}  // namespace sprung::dynamics
