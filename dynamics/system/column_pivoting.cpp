#include "dynamics/system/column_pivoting.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kEqual = 1e-9;        // share by which norms differ that differ by more than rounding
constexpr double kLeastPivot = 1e-12;  // of AᵀA: squares
constexpr int kFewRows = 150;          // up to which the longest column is taken
constexpr int kFewColumns = 150;       // up to which all products cost less than keeping to those that are not zero
const double kAlike = std::log(4.0);   // of a matrix with more: of norms that count as equal

// Rank of a pivot: the same for all that count as equal, growing where pivots get smaller.
double rank_of(double pivot, double largest, double equal) {
  const double size = pivot / largest;
  return size > 0.0 ? -std::round(0.5 * std::log(size) / equal) : 1e300;
}

// What is left of AᵀA while pivots are taken, of a small matrix.
class DenseRemainder {
 public:
  explicit DenseRemainder(const Eigen::SparseMatrix<double>& matrix)
      : products_(matrix.transpose() * matrix), is_left_(static_cast<std::size_t>(matrix.cols())) {
    if (matrix.cols() > 0) largest_pivot_ = products_.diagonal().maxCoeff();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) is_left_[static_cast<std::size_t>(j)] = products_(j, j) > 0.0;
  }

  // Of columns that count as equal the first; −1 where nothing is left.
  int largest() const {
    int best = -1;
    double best_rank = 0.0;
    for (std::size_t j = 0; j < is_left_.size(); ++j) {
      if (!is_left_[j]) continue;
      const double rank = rank_of(pivot(static_cast<int>(j)), largest_pivot_, kEqual);
      if (best >= 0 && !(rank < best_rank)) continue;
      best = static_cast<int>(j);
      best_rank = rank;
    }
    return best;
  }
  double pivot(int column) const { return products_(column, column); }

  void take(int pivot_column) {
    const Eigen::VectorXd column = products_.col(pivot_column);
    products_.noalias() -= column * (column / column[pivot_column]).transpose();
    is_left_[static_cast<std::size_t>(pivot_column)] = false;
    for (std::size_t j = 0; j < is_left_.size(); ++j) {
      if (!(pivot(static_cast<int>(j)) > kLeastPivot * largest_pivot_)) is_left_[j] = false;
    }
  }

 private:
  Eigen::MatrixXd products_;
  std::vector<bool> is_left_;
  double largest_pivot_ = 0.0;
};

// The same of a large one.
class Remainder {
 public:
  explicit Remainder(const Eigen::SparseMatrix<double>& matrix)
      : has_few_rows_(matrix.rows() <= kFewRows), rows_(static_cast<std::size_t>(matrix.cols())) {
    const Eigen::SparseMatrix<double> products = matrix.transpose() * matrix;
    for (int j = 0; j < products.outerSize(); ++j) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(products, j); entry; ++entry) {
        row(j)[static_cast<int>(entry.row())] = entry.value();
        if (entry.row() == j) largest_pivot_ = std::max(largest_pivot_, entry.value());
      }
    }
    for (int j = 0; j < products.outerSize(); ++j) {
      if (row(j).count(j) > 0) by_size_.insert(key(j));
    }
  }

  // Of columns that count as equal the first; −1 where nothing is left.
  int largest() const { return by_size_.empty() ? -1 : by_size_.begin()->column; }
  double pivot(int column) { return row(column).at(column); }

  void take(int pivot_column) {
    by_size_.erase(key(pivot_column));
    const std::map<int, double> pivot_row = std::move(row(pivot_column));
    const double inverse = 1.0 / pivot_row.at(pivot_column);
    std::vector<int> spent;
    for (const auto& [i, value] : pivot_row) {
      if (i == pivot_column) continue;
      by_size_.erase(key(i));
      row(i).erase(pivot_column);
      const double factor = value * inverse;
      for (const auto& [j, other] : pivot_row) {
        if (j != pivot_column) row(i)[j] -= factor * other;
      }
      if (!(pivot(i) > kLeastPivot * largest_pivot_)) spent.push_back(i);
      by_size_.insert(key(i));
    }
    for (const int i : spent) drop(i);
  }

 private:
  struct Key {
    double size;         // ascending where pivots descend; the same for all that count as equal
    std::size_t degree;  // how many columns it is coupled with, where that counts
    int column;
    auto operator<=>(const Key&) const = default;
  };

  std::map<int, double>& row(int i) { return rows_[static_cast<std::size_t>(i)]; }
  Key key(int column) {
    const double equal = has_few_rows_ ? kEqual : kAlike;
    return {rank_of(pivot(column), largest_pivot_, equal), has_few_rows_ ? 0 : row(column).size(), column};
  }

  // A column of which nothing is left is never taken: what is coupled with it need not know.
  void drop(int column) {
    by_size_.erase(key(column));
    for (const auto& [j, value] : row(column)) {
      if (j == column) continue;
      by_size_.erase(key(j));
      row(j).erase(column);
      by_size_.insert(key(j));
    }
    row(column).clear();
  }

  bool has_few_rows_;
  double largest_pivot_ = 0.0;
  std::vector<std::map<int, double>> rows_;
  std::set<Key> by_size_;
};

ColumnPivots choose_densely(const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix.toDense());
  ColumnPivots pivots;
  for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
    pivots.columns.push_back(qr.colsPermutation().indices()[k]);
    pivots.norms.push_back(std::abs(qr.matrixQR()(k, k)));
  }
  return pivots;
}

template <class Remainder>
ColumnPivots choose_from(Remainder remainder, const Eigen::SparseMatrix<double>& matrix) {
  ColumnPivots pivots;
  double first = 0.0;
  while (static_cast<Eigen::Index>(pivots.columns.size()) < matrix.rows()) {
    const int column = remainder.largest();
    const double pivot = column < 0 ? 0.0 : remainder.pivot(column);
    first = std::max(first, pivot);
    if (!(pivot > kLeastPivot * first)) return choose_densely(matrix);
    pivots.columns.push_back(column);
    pivots.norms.push_back(std::sqrt(pivot));
    remainder.take(column);
  }
  return pivots;
}

}  // namespace

ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix) {
  if (matrix.rows() <= kFewRows && matrix.cols() <= kFewColumns) return choose_from(DenseRemainder(matrix), matrix);
  return choose_from(Remainder(matrix), matrix);
}

}  // namespace sprung::dynamics
