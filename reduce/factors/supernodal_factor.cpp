#include "reduce/factors/supernodal_factor.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>
#include <vector>

#include "reduce/factors/row_major.h"
#include "reduce/factors/supernode_columns.h"
#include "reduce/factors/tall_products.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::reduce {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kPanel = 16;  // columns that are eliminated before the next ones see them

// Eliminates the columns of a supernode. @return whether the pivots are as they have to be
bool eliminate(const SupernodeColumns& node, bool is_definite) {
  Eigen::Map<MatrixXd> L(node.values, node.height, node.width);
  MatrixXd DLt;
  for (Index begin = 0; begin < node.width; begin += kPanel) {
    const Index width = std::min(kPanel, node.width - begin), height = node.height - begin;
    auto panel = L.block(begin, begin, height, width);
    if (begin > 0) {
      DLt = L.diagonal().head(begin).asDiagonal() * L.block(begin, 0, width, begin).transpose();
      panel.noalias() -= L.block(begin, 0, height, begin) * DLt;
    }
    for (Index j = 0; j < width; ++j) {
      const Index below = height - j - 1;
      for (Index i = 0; i < j; ++i)
        panel.col(j).tail(below + 1) -= (panel(i, i) * panel(j, i)) * panel.col(i).tail(below + 1);
      const double pivot = panel(j, j);
      if (!std::isfinite(pivot) || pivot == 0.0 || (is_definite && pivot < 0.0)) return false;
      panel.col(j).tail(below) /= pivot;
    }
  }
  return true;
}

// Where entries of a matrix come to stand in the matrix of a supernode, whose columns are those of L and,
// after them, those of what it leaves to the supernodes above it.
class Front {
 public:
  Front(Index num_unknowns, Index most_below)
      : position_(static_cast<std::size_t>(num_unknowns)),
        rest_(static_cast<std::size_t>(most_below * most_below)) {}

  void begin(const SupernodeColumns& node) {
    node_ = node;
    for (Index i = 0; i < node.height; ++i)
      position_[static_cast<std::size_t>(node.rows[i])] = static_cast<int>(i);
    std::fill_n(node.values, node.height * node.width, 0.0);
    std::fill_n(rest_.begin(), node.num_below() * node.num_below(), 0.0);
  }

  // The columns of the matrix itself, in the order of elimination. @param inverse  where each unknown stands
  // in it
  void add(const SparseMatrix& matrix, const std::vector<int>& order, const std::vector<int>& inverse) {
    for (Index j = 0; j < node_.width; ++j) {
      double* column = node_.column(j);
      for (SparseMatrix::InnerIterator entry(matrix, order[static_cast<std::size_t>(node_.first + j)]); entry;
           ++entry) {
        const int row = inverse[static_cast<std::size_t>(entry.row())];
        if (row >= node_.first + j) column[position_[static_cast<std::size_t>(row)]] += entry.value();
      }
    }
  }

  // What a supernode below leaves. @param rest  the columns of its lower triangle
  void add(const int* rows, Index num_rows, const double* rest) {
    places_.resize(static_cast<std::size_t>(num_rows));
    for (Index i = 0; i < num_rows; ++i)
      places_[static_cast<std::size_t>(i)] = position_[static_cast<std::size_t>(rows[i])];
    const int* places = places_.data();
    for (Index j = 0; j < num_rows; ++j) {
      double* to = column(places[j]);
      for (Index i = j; i < num_rows; ++i) to[places[i]] += *rest++;
    }
  }

  // Subtracts what the eliminated columns take from the rest, and appends its lower triangle.
  void leave_rest(std::vector<double>& stack) {
    const Index below = node_.num_below();
    if (below == 0) return;
    const Eigen::Map<const MatrixXd> L(node_.values, node_.height, node_.width);
    Eigen::Map<MatrixXd> rest(rest_.data(), below, below);
    const MatrixXd taken = (-L.diagonal()).asDiagonal() * L.bottomRows(below).transpose();
    for (Index begin = 0; begin < below; begin += kPanel) {  // what lies above the triangle is not read
      const Index width = std::min(kPanel, below - begin);
      add_combinations(L.bottomRows(below - begin), taken.middleCols(begin, width),
                       rest.block(begin, begin, below - begin, width), true);
    }
    for (Index j = 0; j < below; ++j) {
      const double* column = rest.data() + j * below;
      stack.insert(stack.end(), column + j, column + below);
    }
  }

 private:
  // So that a row of the front is an index into it.
  double* column(int place) {
    if (place < node_.width) return node_.column(place);
    return rest_.data() + (place - node_.width) * node_.num_below() - node_.width;
  }

  std::vector<int> position_;  // of each unknown in the front, n
  std::vector<int> places_;
  std::vector<double> rest_;
  SupernodeColumns node_ = {};
};

class SupernodalFactor final : public SparseFactor {
 public:
  SupernodalFactor(const SparseMatrix& matrix, bool is_definite, Supernodes supernodes)
      : supernodes_(std::move(supernodes)) {
    std::size_t size = 0;
    begin_.reserve(supernodes_.size());
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
      begin_.push_back(size);
      const SupernodeColumns node = columns(s);
      size += static_cast<std::size_t>(node.height * node.width);
      most_below_ = std::max(most_below_, node.num_below());
    }
    values_.reset(new double[size]);
    is_usable_ = factorise(matrix, is_definite);
  }

  bool is_usable() const { return is_usable_; }

  MatrixXd solve(const MatrixXd& x) const override {
    MatrixXd solution(x.rows(), x.cols());
    for (Index begin = 0; begin < x.cols(); begin += kMostTogether) {
      const Index width = std::min<Index>(kMostTogether, x.cols() - begin);
      const int num_together = width == 1                   ? 1
                               : width <= kMostTogether / 2 ? kMostTogether / 2
                                                            : kMostTogether;
      solve_together(num_together, x.middleCols(begin, width), solution.middleCols(begin, width));
    }
    return solution;
  }

  int num_negative() const override {
    int number = 0;
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
      const SupernodeColumns node = columns(s);
      for (Index j = 0; j < node.width; ++j) number += node.column(j)[j] < 0.0 ? 1 : 0;
    }
    return number;
  }

  std::unique_ptr<SparseFactor> factor_like(const SparseMatrix& matrix) const override {
    return make_supernodal_factor(matrix, false, supernodes_);
  }

 private:
  SupernodeColumns columns(std::size_t s) const {
    const int first = supernodes_.first[s], rows = supernodes_.rows_begin[s];
    return {.first = first,
            .width = supernodes_.first[s + 1] - first,
            .height = supernodes_.rows_begin[s + 1] - rows,
            .values = values_.get() + begin_[s],
            .rows = supernodes_.rows.data() + rows};
  }

  bool factorise(const SparseMatrix& matrix, bool is_definite) {
    const std::vector<int>& order = supernodes_.order;
    std::vector<int> inverse(order.size());
    for (std::size_t j = 0; j < order.size(); ++j)
      inverse[static_cast<std::size_t>(order[j])] = static_cast<int>(j);
    Front front(matrix.rows(), most_below_);
    std::vector<double> stack;  // what is left of supernodes that are not assembled yet, the last one last
    std::vector<std::size_t> waiting;  // these supernodes
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
      const SupernodeColumns node = columns(s);
      front.begin(node);
      front.add(matrix, order, inverse);
      while (!waiting.empty() && columns(waiting.back()).rows_below()[0] < node.first + node.width) {
        const SupernodeColumns below = columns(waiting.back());
        const auto size = static_cast<std::size_t>(below.num_below() * (below.num_below() + 1) / 2);
        front.add(below.rows_below(), below.num_below(), stack.data() + (stack.size() - size));
        stack.resize(stack.size() - size);
        waiting.pop_back();
      }
      if (!eliminate(node, is_definite)) return false;
      front.leave_rest(stack);
      if (node.num_below() > 0) waiting.push_back(s);
    }
    return true;
  }

  // L D Lᵀ x = b.
  // @param given, solution  n×(up to num_together)
  void solve_together(int num_together, const Eigen::Ref<const MatrixXd>& given,
                      Eigen::Ref<MatrixXd> solution) const {
    const Eigen::Map<const Eigen::VectorXi> order(supernodes_.order.data(), given.rows());
    RowMajorMatrix x = RowMajorMatrix::Zero(given.rows(), num_together);
    x.leftCols(given.cols()) = given(order, Eigen::all);
    std::vector<double> work(static_cast<std::size_t>(most_below_ * num_together));
    for (std::size_t s = 0; s < supernodes_.size(); ++s)
      solve_lower(columns(s), num_together, x.data(), work.data());
    for (std::size_t s = supernodes_.size(); s-- > 0;)
      solve_upper(columns(s), num_together, x.data(), work.data());
    solution(order, Eigen::all) = x.leftCols(given.cols());
  }

  Supernodes supernodes_;
  std::vector<std::size_t> begin_;    // where the values of each supernode begin
  Index most_below_ = 0;              // rows below the triangle of any supernode
  std::unique_ptr<double[]> values_;  // not set to anything before they are used
  bool is_usable_ = false;
};

}  // namespace

std::unique_ptr<SparseFactor> make_supernodal_factor(const SparseMatrix& matrix, bool is_definite,
                                                     Supernodes supernodes) {
  try {
    auto factor = std::make_unique<SupernodalFactor>(matrix, is_definite, std::move(supernodes));
    if (!factor->is_usable()) return nullptr;
    return factor;
  } catch (const std::bad_alloc&) {
    throw support::NumericalError(
        "factors of the stiffness matrix: the memory does not suffice; refine the mesh less");
  }
}

}  // namespace sprung::reduce
