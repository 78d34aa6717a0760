#include "dynamics/system/block_jacobian.h"

namespace sprung::dynamics {

std::size_t BlockJacobian::add_block(const Block& block) {
  blocks_.push_back(block);
  blocks_.back().offset = values_.size();
  values_.resize(values_.size() + static_cast<std::size_t>(block.num_rows * block.num_columns), 0.0);
  always_zero_.resize(values_.size(), false);
  return blocks_.size() - 1;
}

void BlockJacobian::mark_zero(std::size_t block, int row, int column) {
  always_zero_[blocks_[block].offset + static_cast<std::size_t>(row * blocks_[block].num_columns + column)] =
      true;
}

void BlockJacobian::add_product(const Eigen::VectorXd& v, Eigen::VectorXd& r) const {
  for (const Block& block : blocks_) {
    const double* value = values_.data() + block.offset;
    const double* part = v.data() + block.column;
    for (int i = 0; i < block.num_rows; ++i) {
      double sum = value[0] * part[0] + value[1] * part[1] + value[2] * part[2];
      for (int j = 3; j < block.num_columns; ++j) sum += value[j] * part[j];
      value += block.num_columns;
      r[block.row + i] += sum;
    }
  }
}

void BlockJacobian::add_transposed_product(const Eigen::VectorXd& lambda, Eigen::VectorXd& Q) const {
  for (const Block& block : blocks_) {
    const double* value = values_.data() + block.offset;
    double* part = Q.data() + block.column;
    double x = part[0], y = part[1], theta = part[2];
    for (int i = 0; i < block.num_rows; ++i, value += block.num_columns) {
      const double factor = lambda[block.row + i];
      x += value[0] * factor;
      y += value[1] * factor;
      theta += value[2] * factor;
      for (int j = 3; j < block.num_columns; ++j) part[j] += value[j] * factor;
    }
    part[0] = x;
    part[1] = y;
    part[2] = theta;
  }
}

Eigen::MatrixXd BlockJacobian::dense() const {
  return sparse().toDense();
}

Eigen::SparseMatrix<double> BlockJacobian::sparse() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Block& block : blocks_) {
    std::size_t place = block.offset;
    for (int i = 0; i < block.num_rows; ++i) {
      for (int j = 0; j < block.num_columns; ++j, ++place) {
        if (!always_zero_[place]) entries.emplace_back(block.row + i, block.column + j, values_[place]);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(num_rows_, num_columns_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace sprung::dynamics
