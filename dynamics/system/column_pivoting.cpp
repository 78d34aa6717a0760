#include "dynamics/system/column_pivoting.h"

#include <Eigen/QR>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kEqual = 1e-9;        // share by which norms differ that differ by more than rounding
constexpr double kLeastPivot = 1e-12;  // of AᵀA: squares

// What is left of AᵀA while pivots are taken.
class Remainder {
 public:
  explicit Remainder(const Eigen::SparseMatrix<double>& matrix)
      : rows_(static_cast<std::size_t>(matrix.cols())) {
    const Eigen::SparseMatrix<double> products = matrix.transpose() * matrix;
    for (int j = 0; j < products.outerSize(); ++j) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(products, j); entry; ++entry) {
        row(j)[static_cast<int>(entry.row())] = entry.value();
      }
      if (row(j).count(j) > 0) by_size_.emplace(key(j), j);
    }
  }

  int largest() const { return by_size_.empty() ? -1 : by_size_.begin()->second; }
  double pivot(int column) { return row(column).at(column); }

  void take(int pivot_column) {
    by_size_.erase({key(pivot_column), pivot_column});
    const std::map<int, double> pivot_row = std::move(row(pivot_column));
    const double inverse = 1.0 / pivot_row.at(pivot_column);
    for (const auto& [i, value] : pivot_row) {
      if (i == pivot_column) continue;
      by_size_.erase({key(i), i});
      row(i).erase(pivot_column);
      const double factor = value * inverse;
      for (const auto& [j, other] : pivot_row) {
        if (j != pivot_column) row(i)[j] -= factor * other;
      }
      by_size_.emplace(key(i), i);
    }
  }

 private:
  std::map<int, double>& row(int i) { return rows_[static_cast<std::size_t>(i)]; }
  // Ascending where pivots descend; the same for all that differ by rounding.
  double key(int column) {
    const double size = pivot(column);
    return size > 0.0 ? -std::round(0.5 * std::log(size) / kEqual) : 1e300;
  }

  std::vector<std::map<int, double>> rows_;
  std::set<std::pair<double, int>> by_size_;
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

}  // namespace

ColumnPivots choose_columns(const Eigen::SparseMatrix<double>& matrix) {
  Remainder remainder(matrix);
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

}  // namespace sprung::dynamics
