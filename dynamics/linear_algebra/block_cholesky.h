#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace sprung::dynamics {

/// Factors L D Lᵀ of a symmetric positive definite sparse matrix whose values change while its pattern stays.
/// Rows and columns are taken two at a time, as *nodes*: most joints have two, and each index that is looked
/// up serves a 2×2 block. The order of elimination (minimum degree) and the places of all products are found
/// once. After that, factorising and solving are plain loops that allocate no memory; their work grows with
/// the entries of L. Source: [Duff, Erisman & Reid 2017], §§7.3, 11.2
class BlockCholesky {
 public:
  BlockCholesky() = default;
  /// @param couplings  pairs of nodes that share a block, in either order or both; diagonal blocks need none
  BlockCholesky(int num_nodes, const std::vector<std::pair<int, int>>& couplings);

  /// The step, from 0, in which a node is eliminated.
  int step(int node) const { return step_[static_cast<std::size_t>(node)]; }
  /// Index in `blocks` of the block of two nodes; its rows belong to the node that is eliminated later.
  int place(int node, int other) const;
  /// The values of the matrix, to be set before `factorise`, which overwrites them with the factors. Diagonal
  /// blocks are stored in full.
  std::vector<Eigen::Matrix2d>& blocks() { return blocks_; }

  /// @return false if the matrix is not positive definite
  bool factorise();
  /// x ← A⁻¹ x.  @param x  num_nodes, in the order of elimination
  void solve(Eigen::Vector2d* x) const;
  int num_factor_entries() const { return 4 * static_cast<int>(rows_.size()); }

 private:
  int num_nodes_ = 0;
  std::vector<int> step_;     // of each node
  std::vector<int> first_;    // of each step: its diagonal in blocks_, before those below it; num_nodes_ + 1
  std::vector<int> rows_;     // of each block: its step; they ascend in a column
  std::vector<int> targets_;  // for all pairs of blocks below a diagonal: the block that loses their product
  std::vector<Eigen::Matrix2d> blocks_;
};

}  // namespace sprung::dynamics
