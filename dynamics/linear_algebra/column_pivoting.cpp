#include "dynamics/linear_algebra/column_pivoting.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <compare>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kEqual = 1e-9;       // relative difference of lengths that is no more than rounding
constexpr int kFewRows = 150;         // up to which the matrix is decomposed as a dense one
constexpr double kAlike = 2.0;        // factor within which pivots of the elimination count as equal
constexpr double kLeastPivot = 1e-6;  // of the elimination: of the largest one before

// The same number for all sizes that count as equal, larger for smaller sizes.
double rank_of(double size, double largest, double log_equal) {
  return size > 0.0 ? -std::round(std::log(size / largest) / log_equal) : 1e300;
}

struct Pivot {
  int column = -1;    // −1: no column has an entry left
  double size = 0.0;  // length of the column, or size of the entry, that is left
  int row = -1;       // of the entry
};

// What is left of the columns of a dense matrix when what lies along the columns taken is removed (modified
// Gram–Schmidt). Lengths are calculated anew from what is left, so that they are right down to rounding.
class OrthogonalRemainder {
 public:
  explicit OrthogonalRemainder(const Eigen::SparseMatrix<double>& matrix)
      : columns_(matrix.toDense()),
        squares_(columns_.colwise().squaredNorm()),
        is_taken_(static_cast<std::size_t>(matrix.cols()), false),
        largest_square_(squares_.maxCoeff()) {}

  // The longest column, of those that count as equal the first.
  Pivot choose() const {
    Pivot best;
    double best_rank = 0.0;
    for (Eigen::Index j = 0; j < squares_.size(); ++j) {
      if (is_taken_[static_cast<std::size_t>(j)]) continue;
      const double rank = rank_of(squares_[j], largest_square_, 2.0 * kEqual);
      if (best.column >= 0 && !(rank < best_rank)) continue;
      best = {.column = static_cast<int>(j), .size = std::sqrt(squares_[j])};
      best_rank = rank;
    }
    return best;
  }

  void take(const Pivot& pivot) {
    is_taken_[static_cast<std::size_t>(pivot.column)] = true;
    if (!(pivot.size > 0.0)) return;
    const Eigen::VectorXd direction = columns_.col(pivot.column) / pivot.size;
    const Eigen::RowVectorXd along = direction.transpose() * columns_;
    for (Eigen::Index j = 0; j < squares_.size(); ++j) {
      if (along[j] == 0.0) continue;
      columns_.col(j) -= along[j] * direction;
      squares_[j] = columns_.col(j).squaredNorm();
    }
  }

 private:
  Eigen::MatrixXd columns_;
  Eigen::RowVectorXd squares_;  // of the lengths
  std::vector<bool> is_taken_;
  double largest_square_;  // of the matrix
};

// What Gaussian elimination has left of a sparse matrix when the rows and columns of the pivots are gone.
class EliminatedRemainder {
 public:
  explicit EliminatedRemainder(const Eigen::SparseMatrix<double>& matrix)
      : rows_(static_cast<std::size_t>(matrix.rows())), columns_(static_cast<std::size_t>(matrix.cols())) {
    for (int j = 0; j < matrix.outerSize(); ++j) {  // so that the entries of a row ascend
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, j); entry; ++entry) {
        if (entry.value() == 0.0) continue;
        const int i = static_cast<int>(entry.row());
        row(i).push_back({j, entry.value()});
        column(j).push_back(i);
        largest_ = std::max(largest_, std::abs(entry.value()));
      }
    }
    for (const std::vector<int>& column : columns_) first_counts_.push_back(column.size());
    for (int j = 0; j < static_cast<int>(columns_.size()); ++j) add_if_alone(j);
    for (int i = 0; i < static_cast<int>(rows_.size()); ++i) by_size_.insert(key(i));
  }

  // A column with an entry in one row only, if that entry is large enough: it costs no elimination.
  // Otherwise, among the rows with the largest entries, a row with the fewest; among its columns with an
  // entry about as large, the one that costs least.
  Pivot choose() {
    while (!alone_.empty()) {
      const int column = alone_.extract(alone_.begin()).value().second;
      if (columns_[static_cast<std::size_t>(column)].empty()) continue;
      const int only = columns_[static_cast<std::size_t>(column)].front();
      const double size = std::abs(find(row(only), column)->value);
      if (size >= largest_of(row(only)) / kAlike) return {.column = column, .size = size, .row = only};
    }
    if (by_size_.empty()) return {};
    const int largest_row = by_size_.begin()->row;
    const double least = largest_of(row(largest_row)) / kAlike;
    Pivot best;
    Cost least_cost{};
    for (const Entry& entry : row(largest_row)) {
      if (std::abs(entry.value) < least) continue;
      const Cost cost = cost_of(entry.column);
      if (best.column >= 0 && !(cost < least_cost)) continue;
      best = {.column = entry.column, .size = std::abs(entry.value), .row = largest_row};
      least_cost = cost;
    }
    return best;
  }

  void take(const Pivot& pivot) {
    by_size_.erase(key(pivot.row));
    const Row pivot_row = std::move(row(pivot.row));
    const double pivot_value = find(pivot_row, pivot.column)->value;
    for (const Entry& entry : pivot_row) std::erase(column(entry.column), pivot.row);
    for (const int i : std::exchange(column(pivot.column), {})) {
      by_size_.erase(key(i));
      subtract(i, find(row(i), pivot.column)->value / pivot_value, pivot_row, pivot.column);
      by_size_.insert(key(i));
    }
    for (const Entry& entry : pivot_row) add_if_alone(entry.column);
  }

 private:
  struct Entry {
    int column;
    double value;
  };
  using Row = std::vector<Entry>;
  struct Key {
    double rank;  // of the row's largest entry
    std::size_t num_entries;
    int row;
    auto operator<=>(const Key&) const = default;
  };

  // Cost of eliminating a column, compared from the first member on.
  struct Cost {
    std::size_t num_rows, num_rows_at_first;
    std::size_t num_entries;  // of those rows, so that all rows stay short
    auto operator<=>(const Cost&) const = default;
  };

  Row& row(int i) { return rows_[static_cast<std::size_t>(i)]; }
  std::vector<int>& column(int j) { return columns_[static_cast<std::size_t>(j)]; }
  static Row::const_iterator find(const Row& row, int column) {
    return std::lower_bound(row.begin(), row.end(), column,
                            [](const Entry& entry, int wanted) { return entry.column < wanted; });
  }
  static double largest_of(const Row& row) {
    double largest = 0.0;
    for (const Entry& entry : row) largest = std::max(largest, std::abs(entry.value));
    return largest;
  }
  // A row whose entries have grown beyond the largest of the matrix counts like that one: otherwise the
  // longest rows would be taken first.
  Key key(int i) {
    const double size = std::min(largest_of(row(i)), largest_);
    return {rank_of(size, largest_, std::log(kAlike)), row(i).size(), i};
  }

  Cost cost_of(int j) {
    std::size_t num_entries = 0;
    for (const int i : column(j)) num_entries += row(i).size();
    return {column(j).size(), first_counts_[static_cast<std::size_t>(j)], num_entries};
  }

  void add_if_alone(int j) {
    if (column(j).size() == 1) alone_.emplace(first_counts_[static_cast<std::size_t>(j)], j);
  }

  // Row i minus `factor` times another row; its entry in the column chosen is gone.
  void subtract(int i, double factor, const Row& other, int chosen) {
    merged_.clear();
    auto mine = row(i).begin();
    for (const Entry& entry : other) {
      while (mine != row(i).end() && mine->column < entry.column) merged_.push_back(*mine++);
      const bool is_mine = mine != row(i).end() && mine->column == entry.column;
      const double before = is_mine ? (mine++)->value : 0.0;
      if (entry.column == chosen) continue;
      merged_.push_back({entry.column, before - factor * entry.value});
      if (!is_mine) column(entry.column).push_back(i);
    }
    merged_.insert(merged_.end(), mine, row(i).end());
    row(i).swap(merged_);
  }

  std::vector<Row> rows_;
  std::vector<std::vector<int>> columns_;  // rows with an entry in each
  std::vector<std::size_t> first_counts_;  // of each column's rows, before the first pivot
  std::set<Key> by_size_;
  std::set<std::pair<std::size_t, int>> alone_;  // first count and number of each column with one row
  double largest_ = 0.0;
  Row merged_;
};

// @param least_pivot  of the largest one before: the search ends at a smaller pivot, with fewer columns
template <class Remainder>
ColumnPivots choose_from(Remainder remainder, Eigen::Index num_rows, double least_pivot) {
  ColumnPivots pivots;
  double largest = 0.0;
  while (static_cast<Eigen::Index>(pivots.columns.size()) < num_rows) {
    const Pivot pivot = remainder.choose();
    largest = std::max(largest, pivot.size);
    if (pivot.column < 0 || pivot.size < least_pivot * largest) break;
    pivots.columns.push_back(pivot.column);
    pivots.sizes.push_back(pivot.size);
    remainder.take(pivot);
  }
  return pivots;
}

}  // namespace

ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::Index num_rows = matrix.rows();
  if (num_rows == 0) return {};  // a vehicle without joints
  if (num_rows > kFewRows) {
    ColumnPivots pivots = choose_from(EliminatedRemainder(matrix), num_rows, kLeastPivot);
    if (static_cast<Eigen::Index>(pivots.columns.size()) == num_rows) return pivots;
  }
  return choose_from(OrthogonalRemainder(matrix), num_rows, 0.0);
}

}  // namespace sprung::dynamics
