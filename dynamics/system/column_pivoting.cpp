#include "dynamics/system/column_pivoting.h"

#include <cmath>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kEqual = 1e-9;     // share by which norms differ that differ by more than rounding
constexpr double kNothing = 1e-14;  // share of a column that is rounding

using Column = Eigen::SparseVector<double>;

// What is left of the columns while pivots are taken.
class Remainder {
 public:
  explicit Remainder(const Eigen::SparseMatrix<double>& matrix)
      : columns_with_(static_cast<std::size_t>(matrix.rows())) {
    for (int j = 0; j < matrix.cols(); ++j) {
      columns_.emplace_back(matrix.col(j));
      for (Column::InnerIterator entry(columns_.back()); entry; ++entry) with(entry.index()).insert(j);
      first_norms_.push_back(columns_.back().norm());
      keys_.push_back(key(first_norms_.back()));
      by_norm_.emplace(keys_.back(), j);
    }
  }

  int largest() const { return by_norm_.begin()->second; }
  double norm(int column) const { return columns_[static_cast<std::size_t>(column)].norm(); }
  bool is_empty() const { return by_norm_.empty(); }

  // Takes a column away, and from the others what lies along it.
  void take(int pivot) {
    const Column direction = columns_[static_cast<std::size_t>(pivot)] / norm(pivot);
    remove(pivot);
    std::set<int> others;
    for (Column::InnerIterator entry(direction); entry; ++entry) {
      others.insert(with(entry.index()).begin(), with(entry.index()).end());
    }
    for (const int j : others) {
      Column& column = columns_[static_cast<std::size_t>(j)];
      const double along = direction.dot(column);
      if (along == 0.0) continue;
      remove(j);
      column = (column - along * direction).pruned(first_norms_[static_cast<std::size_t>(j)], kNothing);
      insert(j);
    }
  }

 private:
  std::set<int>& with(Eigen::Index row) { return columns_with_[static_cast<std::size_t>(row)]; }
  // Ascending where norms descend; one for all that differ by rounding.
  static double key(double norm) { return norm > 0.0 ? -std::round(std::log(norm) / kEqual) : 1e300; }

  void remove(int j) {
    const auto place = static_cast<std::size_t>(j);
    by_norm_.erase({keys_[place], j});
    for (Column::InnerIterator entry(columns_[place]); entry; ++entry) with(entry.index()).erase(j);
  }
  void insert(int j) {
    const auto place = static_cast<std::size_t>(j);
    keys_[place] = key(columns_[place].norm());
    by_norm_.emplace(keys_[place], j);
    for (Column::InnerIterator entry(columns_[place]); entry; ++entry) with(entry.index()).insert(j);
  }

  std::vector<Column> columns_;
  std::vector<double> first_norms_, keys_;
  std::vector<std::set<int>> columns_with_;  // an entry in a row
  std::set<std::pair<double, int>> by_norm_;
};

}  // namespace

ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix) {
  Remainder remainder(matrix);
  ColumnPivots pivots;
  while (static_cast<int>(pivots.columns.size()) < matrix.rows() && !remainder.is_empty()) {
    const int column = remainder.largest();
    const double norm = remainder.norm(column);
    if (!(norm > 0.0)) break;
    pivots.columns.push_back(column);
    pivots.norms.push_back(norm);
    remainder.take(column);
  }
  return pivots;
}

}  // namespace sprung::dynamics
