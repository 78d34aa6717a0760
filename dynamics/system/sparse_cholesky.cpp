#include "dynamics/system/sparse_cholesky.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

// For each step of the elimination the rows that are coupled with the one eliminated and still there.
struct Elimination {
  std::vector<int> order;
  std::vector<std::vector<int>> coupled;
};

Elimination eliminate_by_degree(int size, const std::vector<std::pair<int, int>>& entries) {
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(size));
  const auto of = [&](int i) -> std::set<int>& { return neighbours[static_cast<std::size_t>(i)]; };
  for (const auto& [i, j] : entries) {
    if (i == j) continue;
    of(i).insert(j);
    of(j).insert(i);
  }
  std::set<std::pair<std::size_t, int>> by_degree;
  for (int i = 0; i < size; ++i) by_degree.emplace(of(i).size(), i);
  Elimination elimination;
  while (!by_degree.empty()) {
    const int row = by_degree.begin()->second;
    by_degree.erase(by_degree.begin());
    const std::set<int> coupled = std::move(of(row));
    for (const int i : coupled) {
      by_degree.erase({of(i).size(), i});
      of(i).erase(row);
      for (const int j : coupled) {
        if (j != i) of(i).insert(j);
      }
      by_degree.emplace(of(i).size(), i);
    }
    elimination.order.push_back(row);
    elimination.coupled.emplace_back(coupled.begin(), coupled.end());
  }
  return elimination;
}

}  // namespace

SparseCholesky::SparseCholesky(int size, const std::vector<std::pair<int, int>>& entries)
    : size_(size), step_(static_cast<std::size_t>(size)), work_(static_cast<std::size_t>(size)) {
  Elimination elimination = eliminate_by_degree(size, entries);
  order_ = std::move(elimination.order);
  for (std::size_t k = 0; k < order_.size(); ++k)
    step_[static_cast<std::size_t>(order_[k])] = static_cast<int>(k);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    first_.push_back(static_cast<int>(rows_.size()));
    rows_.push_back(static_cast<int>(k));
    for (const int i : elimination.coupled[k]) rows_.push_back(step_[static_cast<std::size_t>(i)]);
    std::sort(rows_.begin() + first_.back(), rows_.end());
  }
  first_.push_back(static_cast<int>(rows_.size()));
  values_.assign(rows_.size() + 1, 0.0);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const auto begin = static_cast<std::size_t>(first_[k]) + 1, end = static_cast<std::size_t>(first_[k + 1]);
    for (std::size_t j = begin; j < end; ++j) {
      for (std::size_t i = j; i < end; ++i) {
        targets_.push_back(
            place(order_[static_cast<std::size_t>(rows_[i])], order_[static_cast<std::size_t>(rows_[j])]));
      }
    }
  }
}

int SparseCholesky::place(int i, int j) const {
  const int step_i = step_[static_cast<std::size_t>(i)], step_j = step_[static_cast<std::size_t>(j)];
  const auto column = static_cast<std::size_t>(std::min(step_i, step_j));
  const auto begin = rows_.begin() + first_[column], end = rows_.begin() + first_[column + 1];
  const auto found = std::lower_bound(begin, end, std::max(step_i, step_j));
  if (found == end || *found != std::max(step_i, step_j)) {
    throw std::invalid_argument("SparseCholesky::place: not an entry of the pattern");
  }
  return static_cast<int>(found - rows_.begin());
}

bool SparseCholesky::factorise() {
  bool positive = true;
  const int* target = targets_.data();
  double* values = values_.data();
  for (std::size_t k = 0; k < static_cast<std::size_t>(size_); ++k) {
    double* column = values + first_[k] + 1;
    const int count = first_[k + 1] - first_[k] - 1;
    double& pivot = values[first_[k]];
    positive &= pivot > 0.0;
    const double inverse = 1.0 / pivot;
    pivot = inverse;  // kept inverted: solving then divides nowhere
    for (int j = 0; j < count; ++j) {
      const double factor = column[j] * inverse;
      for (int i = j; i < count; ++i) values[*target++] -= column[i] * factor;
      column[j] = factor;
    }
  }
  return positive;
}

void SparseCholesky::solve(double* x) const {
  double* y = work_.data();
  const double* values = values_.data();
  const int* rows = rows_.data();
  const int* first = first_.data();
  for (int k = 0; k < size_; ++k) y[k] = x[order_[static_cast<std::size_t>(k)]];
  for (int k = 0; k < size_; ++k) {
    const double solved = y[k];
    for (int i = first[k] + 1; i < first[k + 1]; ++i) y[rows[i]] -= values[i] * solved;
  }
  for (int k = size_ - 1; k >= 0; --k) {
    double sum = y[k] * values[first[k]];
    for (int i = first[k] + 1; i < first[k + 1]; ++i) sum -= values[i] * y[rows[i]];
    y[k] = sum;
    x[order_[static_cast<std::size_t>(k)]] = sum;
  }
}

}  // namespace sprung::dynamics
