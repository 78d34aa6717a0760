#include "dynamics/system/multiplier_solver.h"

#include <algorithm>

namespace sprung::dynamics {

namespace {

constexpr int kDenseLimit = 64;  // constraints up to which the dense factorisation is the quicker one

using Block = BlockJacobian::Block;

Eigen::SparseMatrix<double> make_pattern(const std::vector<Block>& blocks, int size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Block& p : blocks) {
    for (const Block& q : blocks) {
      if (p.body != q.body || p.row < q.row) continue;
      for (int i = 0; i < p.num_rows; ++i) {
        for (int j = 0; j < q.num_rows; ++j) entries.emplace_back(p.row + i, q.row + j, 0.0);
      }
    }
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  pattern.makeCompressed();
  return pattern;
}

}  // namespace

MultiplierSolver::MultiplierSolver(const BlockJacobian& jacobian, int num_constraints)
    : num_constraints_(num_constraints), is_dense_(num_constraints <= kDenseLimit) {
  const std::vector<Block>& blocks = jacobian.blocks();
  if (is_dense_) {
    dense_ = Eigen::MatrixXd::Zero(num_constraints, num_constraints);
    // By computing: a factor of a size alone would be copied with its outcome not set.
    dense_factor_.compute(Eigen::MatrixXd::Identity(num_constraints, num_constraints));
  } else {
    sparse_ = make_pattern(blocks, num_constraints);
    sparse_factor_.analyzePattern(sparse_);
  }
  std::size_t rows = 0, modal = 0;
  for (const Block& block : blocks) {
    row_offsets_.push_back(3 * rows);
    modal_offsets_.push_back(modal);
    rows += static_cast<std::size_t>(block.num_rows);
    modal += static_cast<std::size_t>(block.num_rows * (block.num_columns - 3));
  }
  Y_.resize(3 * rows);
  CY_.resize(3 * rows);
  Z_.resize(modal);

  // Only the lower triangle: a pair's first block is the one with the later rows.
  std::vector<std::vector<std::size_t>> blocks_of_body;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto body = static_cast<std::size_t>(blocks[k].body);
    if (blocks_of_body.size() <= body) blocks_of_body.resize(body + 1);
    blocks_of_body[body].push_back(k);
  }
  for (const std::vector<std::size_t>& members : blocks_of_body) {
    for (const std::size_t p : members) {
      for (const std::size_t q : members) {
        if (blocks[p].row < blocks[q].row) continue;
        Pair pair{p, q, {}};
        for (int j = 0; j < blocks[q].num_rows; ++j) {
          const int row = blocks[p].row, column = blocks[q].row + j;
          std::size_t target = static_cast<std::size_t>(column) * static_cast<std::size_t>(num_constraints) +
                               static_cast<std::size_t>(row);
          if (!is_dense_) {
            const int* begin = sparse_.innerIndexPtr() + sparse_.outerIndexPtr()[column];
            const int* end = sparse_.innerIndexPtr() + sparse_.outerIndexPtr()[column + 1];
            target = static_cast<std::size_t>(std::lower_bound(begin, end, row) - sparse_.innerIndexPtr());
          }
          pair.column_targets.push_back(target);
        }
        pairs_.push_back(std::move(pair));
      }
    }
  }
}

bool MultiplierSolver::factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses) {
  const std::vector<Block>& blocks = jacobian.blocks();
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Block& block = blocks[k];
    const BodyMass& mass = masses[static_cast<std::size_t>(block.body)];
    const auto modes = static_cast<std::size_t>(block.num_columns - 3);
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.num_rows); ++i) {
      double* Y = Y_.data() + row_offsets_[k] + 3 * i;
      mass.reduce_row(jacobian.values(k) + i * static_cast<std::size_t>(block.num_columns), Y,
                      Z_.data() + modal_offsets_[k] + modes * i);
      Eigen::Map<Eigen::Vector3d>(CY_.data() + row_offsets_[k] + 3 * i).noalias() =
          mass.rigid_inverse() * Eigen::Map<const Eigen::Vector3d>(Y);
    }
  }
  double* values = is_dense_ ? dense_.data() : sparse_.valuePtr();
  std::fill(values, values + (is_dense_ ? dense_.size() : sparse_.nonZeros()), 0.0);
  for (const Pair& pair : pairs_) {
    const Block& p = blocks[pair.p];
    const Block& q = blocks[pair.q];
    const auto modes = static_cast<std::size_t>(p.num_columns - 3);
    const auto stride = static_cast<std::size_t>(p.num_columns);
    for (std::size_t j = 0; j < static_cast<std::size_t>(q.num_rows); ++j) {
      const double* CY = CY_.data() + row_offsets_[pair.q] + 3 * j;
      const double* Z = Z_.data() + modal_offsets_[pair.q] + modes * j;
      double* column = values + pair.column_targets[j];
      for (std::size_t i = 0; i < static_cast<std::size_t>(p.num_rows); ++i) {
        const double* Y = Y_.data() + row_offsets_[pair.p] + 3 * i;
        const double* G = jacobian.values(pair.p) + i * stride + 3;
        double sum = Y[0] * CY[0] + Y[1] * CY[1] + Y[2] * CY[2];
        for (std::size_t m = 0; m < modes; ++m) sum += G[m] * Z[m];
        column[i] += sum;
      }
    }
  }
  if (is_dense_) {
    dense_factor_.compute(dense_);
    return dense_factor_.info() == Eigen::Success;
  }
  sparse_factor_.factorize(sparse_);
  return sparse_factor_.info() == Eigen::Success;
}

void MultiplierSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const {
  lambda = r;
  if (is_dense_) dense_factor_.solveInPlace(lambda);
  else lambda = sparse_factor_.solve(r);
}

}  // namespace sprung::dynamics
