#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace sprung::dynamics {

/// φ_q as the blocks it consists of: a joint touches the coordinates of two bodies and no others.
class BlockJacobian {
 public:
  /// Rows of one joint, columns of one body; stored row by row.
  struct Block {
    int row = 0, num_rows = 0;        ///< constraints
    int column = 0, num_columns = 0;  ///< coordinates, at least a body's 3
    int body = 0;
    std::size_t offset = 0;  ///< of its values
  };

  BlockJacobian() = default;
  BlockJacobian(int num_rows, int num_columns) : num_rows_(num_rows), num_columns_(num_columns) {}
  /// Adds a block of zeros. @return its number
  std::size_t add_block(const Block& block);
  /// Says that a value (row and column of the block) is zero at all positions.
  void mark_zero(std::size_t block, int row, int column);
  /// @param value  its place in data()
  bool is_always_zero(std::size_t value) const { return always_zero_[value]; }

  const std::vector<Block>& blocks() const { return blocks_; }
  const double* values(std::size_t block) const { return values_.data() + blocks_[block].offset; }
  double* values(std::size_t block) { return values_.data() + blocks_[block].offset; }
  const double* data() const { return values_.data(); }
  double* data() { return values_.data(); }

  /// r += φ_q v.  @param r num_rows  @param v num_columns
  void add_product(const Eigen::VectorXd& v, Eigen::VectorXd& r) const;
  /// Q += φ_qᵀ λ.  @param lambda num_rows  @param Q num_columns
  void add_transposed_product(const Eigen::VectorXd& lambda, Eigen::VectorXd& Q) const;
  /// The same as a matrix, num_rows×num_columns, for work that is done once; `sparse` without values that are
  /// always zero.
  Eigen::MatrixXd dense() const;
  Eigen::SparseMatrix<double> sparse() const;

 private:
  int num_rows_ = 0, num_columns_ = 0;
  std::vector<Block> blocks_;
  std::vector<double> values_;
  std::vector<bool> always_zero_;  // beside values_
};

}  // namespace sprung::dynamics
