#include "dynamics/linear_algebra/block_cholesky.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

// The nodes in the order of elimination and, for each, the remaining nodes that are then coupled with it.
struct EliminationOrder {
  std::vector<int> order;
  std::vector<std::vector<int>> coupled;
};

EliminationOrder find_minimum_degree_order(int num_nodes, const std::vector<std::pair<int, int>>& couplings) {
  std::vector<std::set<int>> neighbours(static_cast<std::size_t>(num_nodes));
  const auto of = [&](int i) -> std::set<int>& { return neighbours[static_cast<std::size_t>(i)]; };
  for (const auto& [i, j] : couplings) {
    if (i == j) continue;
    of(i).insert(j);
    of(j).insert(i);
  }
  std::set<std::pair<std::size_t, int>> by_degree;
  for (int i = 0; i < num_nodes; ++i) by_degree.emplace(of(i).size(), i);
  EliminationOrder elimination;
  while (!by_degree.empty()) {
    const int node = by_degree.begin()->second;
    by_degree.erase(by_degree.begin());
    const std::set<int> coupled = std::move(of(node));
    for (const int i : coupled) {
      by_degree.erase({of(i).size(), i});
      of(i).erase(node);
      for (const int j : coupled) {
        if (j != i) of(i).insert(j);
      }
      by_degree.emplace(of(i).size(), i);
    }
    elimination.order.push_back(node);
    elimination.coupled.emplace_back(coupled.begin(), coupled.end());
  }
  return elimination;
}

// A diagonal block [a b; b c] as its own factors: 1/a, b/a in both other places, and 1/(c − b²/a).
// @return false where it is not positive definite
bool factorise_diagonal(Eigen::Matrix2d& block) {
  const double a = block(0, 0), b = block(1, 0), determinant = a * block(1, 1) - b * b;
  const double inverse = 1.0 / a, lower = b * inverse;
  block << inverse, lower, lower, a / determinant;  // two divisions that do not wait for each other
  return a > 0.0 && determinant > 0.0;
}

// (x, y) ← D⁻¹ (x, y) for two numbers or two columns, by the factors of D.
template <class Value>
void solve_diagonal(const Eigen::Matrix2d& factors, Value& x, Value& y) {
  y = (y - factors(1, 0) * x) * factors(1, 1);
  x = x * factors(0, 0) - factors(1, 0) * y;
}

}  // namespace

BlockCholesky::BlockCholesky(int num_nodes, const std::vector<std::pair<int, int>>& couplings)
    : num_nodes_(num_nodes), step_(static_cast<std::size_t>(num_nodes)) {
  const EliminationOrder elimination = find_minimum_degree_order(num_nodes, couplings);
  const std::vector<int>& order = elimination.order;
  for (std::size_t k = 0; k < order.size(); ++k)
    step_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  for (std::size_t k = 0; k < order.size(); ++k) {
    first_.push_back(static_cast<int>(rows_.size()));
    rows_.push_back(static_cast<int>(k));
    for (const int i : elimination.coupled[k]) rows_.push_back(step(i));
    std::sort(rows_.begin() + first_.back(), rows_.end());
  }
  first_.push_back(static_cast<int>(rows_.size()));
  blocks_.assign(rows_.size(), Eigen::Matrix2d::Zero());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto begin = static_cast<std::size_t>(first_[k]) + 1, end = static_cast<std::size_t>(first_[k + 1]);
    for (std::size_t j = begin; j < end; ++j) {
      for (std::size_t i = j; i < end; ++i) {
        targets_.push_back(
            place(order[static_cast<std::size_t>(rows_[i])], order[static_cast<std::size_t>(rows_[j])]));
      }
    }
  }
}

int BlockCholesky::place(int node, int other) const {
  const auto [column, row] = std::minmax({step(node), step(other)});
  const auto begin = rows_.begin() + first_[static_cast<std::size_t>(column)];
  const auto end = rows_.begin() + first_[static_cast<std::size_t>(column) + 1];
  const auto found = std::lower_bound(begin, end, row);
  if (found == end || *found != row)
    throw std::invalid_argument("BlockCholesky::place: not a block of the pattern");
  return static_cast<int>(found - rows_.begin());
}

bool BlockCholesky::factorise() {
  bool positive = true;
  const int* target = targets_.data();
  Eigen::Matrix2d* blocks = blocks_.data();
  for (int k = 0; k < num_nodes_; ++k) {
    const int diagonal = first_[static_cast<std::size_t>(k)], end = first_[static_cast<std::size_t>(k) + 1];
    positive &= factorise_diagonal(blocks[diagonal]);
    for (int j = diagonal + 1; j < end; ++j) {
      Eigen::Vector2d left = blocks[j].col(0), right = blocks[j].col(1);
      solve_diagonal(blocks[diagonal], left, right);
      for (int i = j; i < end; ++i) {
        Eigen::Matrix2d& from = blocks[*target++];
        from.noalias() -= blocks[i].col(0) * left.transpose();
        from.noalias() -= blocks[i].col(1) * right.transpose();
      }
      blocks[j] << left, right;
    }
  }
  return positive;
}

void BlockCholesky::solve(Eigen::Vector2d* x) const {
  const Eigen::Matrix2d* blocks = blocks_.data();
  const int* rows = rows_.data();
  const int* first = first_.data();
  for (int k = 0; k < num_nodes_; ++k) {
    const double upper = x[k].x(), lower = x[k].y();
    for (int i = first[k] + 1; i < first[k + 1]; ++i) {
      x[rows[i]] -= blocks[i].col(0) * upper + blocks[i].col(1) * lower;
    }
  }
  for (int k = num_nodes_ - 1; k >= 0; --k) {
    double upper = x[k].x(), lower = x[k].y();
    solve_diagonal(blocks[first[k]], upper, lower);
    for (int i = first[k] + 1; i < first[k + 1]; ++i) {
      const Eigen::Vector2d& other = x[rows[i]];
      upper -= blocks[i](0, 0) * other.x() + blocks[i](1, 0) * other.y();
      lower -= blocks[i](0, 1) * other.x() + blocks[i](1, 1) * other.y();
    }
    x[k] = {upper, lower};
  }
}

}  // namespace sprung::dynamics
