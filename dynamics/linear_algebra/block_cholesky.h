#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace sprung::dynamics {

/// Factors L D Lᵀ of a symmetric positive definite sparse matrix whose pattern stays and whose values come
/// again and again. Its rows and columns are taken two at a time, as nodes: what most joints have, and no
/// index is looked up for less than a 2×2 block. The order of elimination (minimum degree) and the places of
/// all products are found once; factorising and solving are plain loops that ask for no memory, their work
/// grows with the entries of L. Source: [Duff, Erisman & Reid 2017], §§7.3, 11.2
class BlockCholesky {
 public:
  BlockCholesky() = default;
  /// @param couplings  pairs of nodes with a block, in either order or both; the diagonal is in it anyway
  BlockCholesky(int num_nodes, const std::vector<std::pair<int, int>>& couplings);

  /// When a node is eliminated, from 0.
  int step(int node) const { return step_[static_cast<std::size_t>(node)]; }
  /// Which of the blocks couples two nodes: its rows are those of the node that is eliminated later.
  int place(int node, int other) const;
  /// Fill before `factorise`, which writes the factors over it. Diagonal blocks in full.
  std::vector<Eigen::Matrix2d>& blocks() { return blocks_; }

  /// @return false where the matrix is not positive definite
  bool factorise();
  /// x ← A⁻¹ x.  @param x  of each node, in the order of elimination
  void solve(Eigen::Vector2d* x) const;
  int num_factor_entries() const { return 4 * static_cast<int>(rows_.size()); }

 private:
  int num_nodes_ = 0;
  std::vector<int> step_;
  std::vector<int>
      first_;  // of each step's entries in blocks_: the diagonal, then those below; num_nodes_ + 1
  std::vector<int> rows_;     // beside blocks_: steps, ascending in a column
  std::vector<int> targets_;  // for all pairs of blocks below a diagonal: what their product is taken from
  std::vector<Eigen::Matrix2d> blocks_;
};

}  // namespace sprung::dynamics
