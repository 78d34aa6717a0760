#include "dynamics/linear_algebra/sparse_lu.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kThreshold = 0.1;    // smallest pivot, relative to the largest entry of its row
constexpr double kPivotDecay = 0.02;  // relative to its first size: with a smaller pivot, all are chosen anew
constexpr int kNumRowsSearched = 4;   // rows with the fewest entries, among which a pivot is chosen

}  // namespace

// What elimination has left of the matrix while pivots are chosen: the active submatrix.
struct SparseLu::ActiveSubmatrix {
  std::vector<std::map<int, double>> rows;  // by column
  std::vector<std::set<int>> columns;       // rows with an entry there
  std::set<std::pair<std::size_t, int>> rows_by_count;

  ActiveSubmatrix(int size, const std::vector<Position>& entries, std::span<const double> values)
      : rows(static_cast<std::size_t>(size)), columns(static_cast<std::size_t>(size)) {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      row(entries[k].row)[entries[k].column] += values[k];
      column(entries[k].column).insert(entries[k].row);
    }
    for (int i = 0; i < size; ++i) rows_by_count.emplace(row(i).size(), i);
  }
  std::map<int, double>& row(int i) { return rows[static_cast<std::size_t>(i)]; }
  std::set<int>& column(int j) { return columns[static_cast<std::size_t>(j)]; }

  Position choose() {
    Position best{-1, -1};
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

  void eliminate(const Position& pivot) {
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

SparseLu::SparseLu(int size, std::vector<Position> entries)
    : size_(size), entries_(std::move(entries)), work_(static_cast<std::size_t>(size)) {}

void SparseLu::choose_pivots(std::span<const double> values) {
  const auto size = static_cast<std::size_t>(size_);
  std::vector<int> step_of_row(size), step_of_column(size);
  std::vector<std::vector<int>> upper(size), lower(size);  // of each step: columns and rows of A
  std::vector<std::vector<Product>> forward(size);
  steps_.clear();
  ActiveSubmatrix matrix(size_, entries_, values);
  int num_factors = 0;
  for (std::size_t k = 0; k < size; ++k) {
    const Position pivot = matrix.choose();
    for (const auto& [j, value] : matrix.row(pivot.row)) {
      if (j != pivot.column) upper[k].push_back(j);
    }
    for (const int i : matrix.column(pivot.column)) {
      if (i != pivot.row) lower[k].push_back(i);
    }
    step_of_row[static_cast<std::size_t>(pivot.row)] = static_cast<int>(k);
    step_of_column[static_cast<std::size_t>(pivot.column)] = static_cast<int>(k);
    steps_.push_back({.first = num_factors,
                      .num_upper = static_cast<int>(upper[k].size()),
                      .num_lower = static_cast<int>(lower[k].size()),
                      .row = pivot.row,
                      .column = pivot.column});
    num_factors += 1 + steps_.back().num_upper + steps_.back().num_lower;
    matrix.eliminate(pivot);
  }

  // An entry is stored with the step of its row or of its column, whichever comes first.
  factors_.assign(static_cast<std::size_t>(num_factors), 0.0);
  forward_.clear();
  upper_columns_.clear();
  std::map<std::pair<int, int>, int> places;  // by steps of row and column
  for (std::size_t k = 0; k < size; ++k) {
    const int step = static_cast<int>(k);
    int place = steps_[k].first;
    places[{step, step}] = place++;
    for (const int j : upper[k]) {
      const int column = step_of_column[static_cast<std::size_t>(j)];
      upper_columns_.push_back(column);
      places[{step, column}] = place++;
    }
    for (const int i : lower[k]) {
      const int row = step_of_row[static_cast<std::size_t>(i)];
      forward[static_cast<std::size_t>(row)].push_back({step, place});
      places[{row, step}] = place++;
    }
  }
  for (std::size_t k = 0; k < size; ++k) {
    forward_.insert(forward_.end(), forward[k].begin(), forward[k].end());
    steps_[k].end_of_forward = static_cast<int>(forward_.size());
  }
  places_.clear();
  for (const Position& entry : entries_) {
    places_.push_back(places.at({step_of_row[static_cast<std::size_t>(entry.row)],
                                 step_of_column[static_cast<std::size_t>(entry.column)]}));
  }
  targets_.clear();
  for (std::size_t k = 0; k < size; ++k) {
    for (const int i : lower[k]) {
      for (const int j : upper[k]) {
        targets_.push_back(places.at(
            {step_of_row[static_cast<std::size_t>(i)], step_of_column[static_cast<std::size_t>(j)]}));
      }
    }
  }
  // The sign of the permutation from the steps' rows to their columns: each cycle of even length reverses it.
  permutation_sign_ = 1.0;
  std::vector<bool> seen(size, false);
  for (std::size_t start = 0; start < size; ++start) {
    int length = 0;
    for (std::size_t i = start; !seen[i]; ++length) {
      seen[i] = true;
      i = static_cast<std::size_t>(steps_[static_cast<std::size_t>(step_of_row[i])].column);
    }
    if (length > 0 && length % 2 == 0) permutation_sign_ = -permutation_sign_;
  }
}

void SparseLu::load(std::span<const double> values) {
  std::fill(factors_.begin(), factors_.end(), 0.0);
  for (std::size_t k = 0; k < places_.size(); ++k)
    factors_[static_cast<std::size_t>(places_[k])] += values[k];
}

// @return false if a pivot has become small compared with its first size
bool SparseLu::eliminate() {
  bool good = true;
  determinant_ = permutation_sign_;
  const int* target = targets_.data();
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const Step& step = steps_[k];
    double* pivot = factors_.data() + step.first;
    double* upper = pivot + 1;
    double* lower = pivot + 1 + step.num_upper;
    good &= std::abs(*pivot) >= kPivotDecay * first_pivots_[k];
    determinant_ *= *pivot;
    const double inverse = 1.0 / *pivot;
    *pivot = inverse;  // stored inverted, so that solving needs no division
    for (int i = 0; i < step.num_lower; ++i) {
      lower[i] *= inverse;
      for (int j = 0; j < step.num_upper; ++j)
        factors_[static_cast<std::size_t>(*target++)] -= lower[i] * upper[j];
    }
    for (int j = 0; j < step.num_upper; ++j) upper[j] *= inverse;
  }
  return good;
}

void SparseLu::factorise(std::span<const double> values) {
  if (!steps_.empty() || size_ == 0) {
    load(values);
    if (eliminate()) return;
  }
  choose_pivots(values);
  first_pivots_.assign(steps_.size(), 0.0);
  load(values);
  eliminate();
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double size = 1.0 / std::abs(factors_[static_cast<std::size_t>(steps_[k].first)]);
    first_pivots_[k] =
        size > 0.0 ? size : std::numeric_limits<double>::infinity();  // singular: chosen anew next time
  }
}

void SparseLu::solve(double* x) const {
  double* y = work_.data();
  const double* factors = factors_.data();
  const auto size = static_cast<std::size_t>(size_);
  const Product* left = forward_.data();
  for (std::size_t k = 0; k < size; ++k) {
    double sum = x[steps_[k].row];
    for (const Product* end = forward_.data() + steps_[k].end_of_forward; left < end; ++left) {
      sum -= factors[left->place] * y[left->step];
    }
    y[k] = sum;
  }
  const int* column = upper_columns_.data() + upper_columns_.size();
  for (std::size_t k = size; k-- > 0;) {
    const double* pivot = factors + steps_[k].first;
    double sum = y[k] * *pivot;
    column -= steps_[k].num_upper;
    for (int j = 0; j < steps_[k].num_upper; ++j) sum -= pivot[1 + j] * y[column[j]];
    y[k] = sum;
    x[steps_[k].column] = sum;
  }
}

}  // namespace sprung::dynamics
