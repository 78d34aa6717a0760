#include "dynamics/linear_algebra/column_pivoting.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <compare>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kEqual = 1e-9;       // share by which norms differ that differ by more than rounding
constexpr double kLeastPivot = 1e-6;  // of the largest one before
constexpr int kFewRows = 150;         // up to which the longest column is taken
constexpr double kAlike = 2.0;        // of a matrix with more: factor within which sizes count as equal

// The same for all sizes that count as equal, growing where they get smaller.
double rank_of(double size, double largest, double log_equal) {
  return size > 0.0 ? -std::round(std::log(size / largest) / log_equal) : 1e300;
}

struct Pivot {
  int column = -1;    // −1: nothing is left
  double size = 0.0;  // of what is left of it
  int row = -1;       // where it is one entry
};

// What is left of the columns of a matrix of few rows while they are taken: QR by its rows, of which AᵀA −
// RᵀR needs no more than the diagonal.
class Remainder {
 public:
  explicit Remainder(const Eigen::SparseMatrix<double>& matrix)
      : matrix_(matrix),
        rows_(Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols())),
        squares_(matrix.cols()),
        is_left_(static_cast<std::size_t>(matrix.cols())) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      squares_[j] = matrix.col(j).squaredNorm();
      is_left_[static_cast<std::size_t>(j)] = squares_[j] > 0.0;
    }
    if (matrix.cols() > 0) largest_square_ = squares_.maxCoeff();
  }

  // The longest column, of those that count as equal the first.
  Pivot choose() const {
    Pivot best;
    double best_rank = 0.0;
    for (Eigen::Index j = 0; j < squares_.size(); ++j) {
      if (!is_left_[static_cast<std::size_t>(j)]) continue;
      const double rank = rank_of(squares_[j], largest_square_, 2.0 * kEqual);
      if (best.column >= 0 && !(rank < best_rank)) continue;
      best = {.column = static_cast<int>(j), .size = std::sqrt(squares_[j])};
      best_rank = rank;
    }
    return best;
  }

  void take(const Pivot& pivot) {
    const int column = pivot.column;
    const Eigen::VectorXd taken = matrix_.col(column);
    Eigen::VectorXd row = matrix_.transpose() * taken;
    row.noalias() -= rows_.topRows(num_taken_).transpose() * rows_.col(column).head(num_taken_);
    row /= pivot.size;
    rows_.row(num_taken_++) = row;
    squares_ -= row.cwiseAbs2();
    is_left_[static_cast<std::size_t>(column)] = false;
    for (Eigen::Index j = 0; j < squares_.size(); ++j) {
      if (!(squares_[j] > kLeastPivot * kLeastPivot * largest_square_))
        is_left_[static_cast<std::size_t>(j)] = false;
    }
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  Eigen::MatrixXd rows_;     // of R, those of the columns taken
  Eigen::VectorXd squares_;  // of the lengths left
  std::vector<bool> is_left_;
  Eigen::Index num_taken_ = 0;
  double largest_square_ = 0.0;
};

// What is left of a matrix of many rows while it is eliminated by rows and columns.
class Elimination {
 public:
  explicit Elimination(const Eigen::SparseMatrix<double>& matrix)
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
    for (int j = 0; j < static_cast<int>(columns_.size()); ++j) note_if_alone(j);
    for (int i = 0; i < static_cast<int>(rows_.size()); ++i) by_size_.insert(key(i));
  }

  // A column that is in one row alone and is large enough there: nothing is left to be eliminated. Else, of
  // the rows with the largest entries, one that has the fewest; of its columns with an entry about as large
  // that which costs least.
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
    for (const Entry& entry : pivot_row) note_if_alone(entry.column);
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

  // Of eliminating a column.
  struct Cost {
    std::size_t num_rows, num_rows_at_first;
    std::size_t num_entries;  // of those rows: even growth keeps all of them short
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
  // Rows that grow beyond what the matrix had at first gain nothing by it, or the longest would be taken
  // first.
  Key key(int i) {
    const double size = std::min(largest_of(row(i)), largest_);
    return {rank_of(size, largest_, std::log(kAlike)), row(i).size(), i};
  }

  Cost cost_of(int j) {
    std::size_t num_entries = 0;
    for (const int i : column(j)) num_entries += row(i).size();
    return {column(j).size(), first_counts_[static_cast<std::size_t>(j)], num_entries};
  }

  void note_if_alone(int j) {
    if (column(j).size() == 1) alone_.emplace(first_counts_[static_cast<std::size_t>(j)], j);
  }

  // Row i less `factor` times another, of which nothing is left in the column chosen.
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
  std::vector<std::vector<int>> columns_;  // rows with an entry there
  std::vector<std::size_t> first_counts_;  // of rows, before the first was taken
  std::set<Key> by_size_;
  std::set<std::pair<std::size_t, int>> alone_;  // columns in one row, with their first counts
  double largest_ = 0.0;
  Row merged_;
};

ColumnPivots choose_densely(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix.toDense());
  ColumnPivots pivots;
  for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
    pivots.columns.push_back(qr.colsPermutation().indices()[k]);
    pivots.sizes.push_back(std::abs(qr.matrixQR()(k, k)));
  }
  return pivots;
}

template <class What>
ColumnPivots choose_from(What left, const Eigen::SparseMatrix<double>& matrix) {
  ColumnPivots pivots;
  double largest = 0.0;
  while (static_cast<Eigen::Index>(pivots.columns.size()) < matrix.rows()) {
    const Pivot pivot = left.choose();
    largest = std::max(largest, pivot.size);
    if (!(pivot.size > kLeastPivot * largest)) return choose_densely(matrix);
    pivots.columns.push_back(pivot.column);
    pivots.sizes.push_back(pivot.size);
    left.take(pivot);
  }
  return pivots;
}

}  // namespace

ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix) {
  if (matrix.rows() == 0) return {};  // a vehicle without joints
  if (matrix.rows() <= kFewRows) return choose_from(Remainder(matrix), matrix);
  return choose_from(Elimination(matrix), matrix);
}

}  // namespace sprung::dynamics
