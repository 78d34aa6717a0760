#include "dynamics/linear_algebra/pivot_order.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kThreshold = 0.1;   // smallest pivot, relative to the largest entry of its row
constexpr int kNumRowsSearched = 4;  // rows with the fewest entries, among which a pivot is chosen

// What elimination has left of the matrix while pivots are chosen: the active submatrix.
struct ActiveSubmatrix {
  std::vector<std::map<int, double>> rows;  // by column
  std::vector<std::set<int>> columns;       // rows with an entry there
  std::set<std::pair<std::size_t, int>> rows_by_count;

  ActiveSubmatrix(int size, const std::vector<MatrixPosition>& entries, std::span<const double> values)
      : rows(static_cast<std::size_t>(size)), columns(static_cast<std::size_t>(size)) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      row(entries[k].row)[entries[k].column] += values[k];
      column(entries[k].column).insert(entries[k].row);
    }
    for (int i = 0; i < size; ++i) rows_by_count.emplace(row(i).size(), i);
  }
  std::map<int, double>& row(int i) { return rows[static_cast<std::size_t>(i)]; }
  std::set<int>& column(int j) { return columns[static_cast<std::size_t>(j)]; }

  MatrixPosition choose() {
    MatrixPosition best{-1, -1};
    std::size_t least_cost = 0;
    double best_size = -1.0;
    int searched = 0;
    for (const auto& [count, i] : rows_by_count) {
      if (++searched > kNumRowsSearched && best.row >= 0) break;
      double largest = 0.0;
      for (const auto& [j, value] : row(i)) largest = std::max(largest, std::abs(value));
      for (const auto& [j, value] : row(i)) {
        if (!(std::abs(value) >= kThreshold * largest)) continue;
        const std::size_t cost = (count - 1) * (column(j).size() - 1);
        if (best.row >= 0 && (cost > least_cost || (cost == least_cost && std::abs(value) <= best_size)))
          continue;
        best = {i, j};
        least_cost = cost;
        best_size = std::abs(value);
      }
    }
    // No entry passes if the values are NaN. Any pivot will do: the result is NaN.
    if (best.row < 0)
      best = {rows_by_count.begin()->second, row(rows_by_count.begin()->second).begin()->first};
    return best;
  }

  void eliminate(const MatrixPosition& pivot) {
    const std::map<int, double> pivot_row = std::move(row(pivot.row));
    rows_by_count.erase({pivot_row.size(), pivot.row});
    for (const auto& [j, value] : pivot_row) column(j).erase(pivot.row);
    for (const int i : column(pivot.column)) {
      std::map<int, double>& target = row(i);
      rows_by_count.erase({target.size(), i});
      const double factor = target[pivot.column] / pivot_row.at(pivot.column);
      target.erase(pivot.column);
      for (const auto& [j, value] : pivot_row) {
        if (j == pivot.column) continue;
        target[j] -= factor * value;
        column(j).insert(i);
      }
      rows_by_count.emplace(target.size(), i);
    }
    column(pivot.column).clear();
  }
};

}  // namespace

std::vector<EliminationStep> choose_pivot_order(int size, const std::vector<MatrixPosition>& entries,
                                                std::span<const double> values) {
  std::vector<EliminationStep> order;
  ActiveSubmatrix matrix(size, entries, values);
  while (static_cast<int>(order.size()) < size) {
    const MatrixPosition position = matrix.choose();
    EliminationStep pivot{.row = position.row, .column = position.column, .upper = {}, .lower = {}};
    for (const auto& [j, value] : matrix.row(position.row)) {
      if (j != position.column) pivot.upper.push_back(j);
    }
    for (const int i : matrix.column(position.column)) {
      if (i != position.row) pivot.lower.push_back(i);
    }
    order.push_back(std::move(pivot));
    matrix.eliminate(position);
  }
  return order;
}

}  // namespace sprung::dynamics
