#include "dynamics/linear_algebra/sparse_lu.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace sprung::dynamics {

namespace {

constexpr double kPivotDecay = 0.02;  // relative to its first size: with a smaller pivot, all are chosen anew

// Steps of the elimination at which the rows and columns of the matrix have their pivots.
struct StepsOfPivots {
  std::vector<int> rows, columns;

  explicit StepsOfPivots(const std::vector<EliminationStep>& order)
      : rows(order.size()), columns(order.size()) {
    for (std::size_t k = 0; k < order.size(); ++k) {
      rows[static_cast<std::size_t>(order[k].row)] = static_cast<int>(k);
      columns[static_cast<std::size_t>(order[k].column)] = static_cast<int>(k);
    }
  }
  int of_row(int i) const { return rows[static_cast<std::size_t>(i)]; }
  int of_column(int j) const { return columns[static_cast<std::size_t>(j)]; }
};

// Sign of the permutation from the pivots' rows to their columns: each cycle of even length reverses it.
double calc_permutation_sign(const std::vector<EliminationStep>& order, const StepsOfPivots& steps) {
  double sign = 1.0;
  std::vector<bool> seen(order.size(), false);
  for (std::size_t start = 0; start < order.size(); ++start) {
    int length = 0;
    for (std::size_t i = start; !seen[i]; ++length) {
      seen[i] = true;
      i = static_cast<std::size_t>(order[static_cast<std::size_t>(steps.rows[i])].column);
    }
    if (length > 0 && length % 2 == 0) sign = -sign;
  }
  return sign;
}

}  // namespace

SparseLu::SparseLu(int size, std::vector<MatrixPosition> entries)
    : size_(size), entries_(std::move(entries)), work_(static_cast<std::size_t>(size)) {}

void SparseLu::choose_pivots(std::span<const double> values) {
  const std::vector<EliminationStep> order = choose_pivot_order(size_, entries_, values);
  const StepsOfPivots steps(order);
  // An entry is stored with the step of its row or of its column, whichever comes first.
  std::map<std::pair<int, int>, int> places;                // by steps of row and column
  std::vector<std::vector<Product>> forward(order.size());  // rows of L
  steps_.clear();
  upper_columns_.clear();
  int place = 0;
  for (int k = 0; k < size_; ++k) {
    const EliminationStep& pivot = order[static_cast<std::size_t>(k)];
    steps_.push_back({.first = place,
                      .num_upper = static_cast<int>(pivot.upper.size()),
                      .num_lower = static_cast<int>(pivot.lower.size()),
                      .row = pivot.row,
                      .column = pivot.column});
    places[{k, k}] = place++;
    for (const int j : pivot.upper) {
      upper_columns_.push_back(steps.of_column(j));
      places[{k, steps.of_column(j)}] = place++;
    }
    for (const int i : pivot.lower) {
      forward[static_cast<std::size_t>(steps.of_row(i))].push_back({k, place});
      places[{steps.of_row(i), k}] = place++;
    }
  }
  factors_.assign(static_cast<std::size_t>(place), 0.0);
  forward_.clear();
  for (std::size_t k = 0; k < order.size(); ++k) {
    forward_.insert(forward_.end(), forward[k].begin(), forward[k].end());
    steps_[k].end_of_forward = static_cast<int>(forward_.size());
  }
  const auto find_place = [&](int row, int column) {
    return places.at({steps.of_row(row), steps.of_column(column)});
  };
  places_.clear();
  for (const MatrixPosition& entry : entries_) places_.push_back(find_place(entry.row, entry.column));
  targets_.clear();
  for (const EliminationStep& pivot : order) {
    for (const int i : pivot.lower) {
      for (const int j : pivot.upper) targets_.push_back(find_place(i, j));
    }
  }
  permutation_sign_ = calc_permutation_sign(order, steps);
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

void SparseLu::solve_transposed(double* x) const {
  double* y = work_.data();
  const double* factors = factors_.data();
  const auto size = static_cast<std::size_t>(size_);
  for (std::size_t k = 0; k < size; ++k) y[k] = x[steps_[k].column];
  const int* column = upper_columns_.data();
  for (std::size_t k = 0; k < size; ++k) {
    const double* pivot = factors + steps_[k].first;
    for (int j = 0; j < steps_[k].num_upper; ++j) y[*column++] -= pivot[1 + j] * y[k];
    y[k] *= *pivot;
  }
  for (std::size_t k = size; k-- > 0;) {
    const int begin = k == 0 ? 0 : steps_[k - 1].end_of_forward;
    for (int i = begin; i < steps_[k].end_of_forward; ++i) {
      const Product& left = forward_[static_cast<std::size_t>(i)];
      y[left.step] -= factors[left.place] * y[k];
    }
    x[steps_[k].row] = y[k];
  }
}

}  // namespace sprung::dynamics
