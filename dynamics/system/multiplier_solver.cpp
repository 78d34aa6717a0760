#include "dynamics/system/multiplier_solver.h"

#include <utility>

namespace sprung::dynamics {

namespace {

using Block = BlockJacobian::Block;

// Pairs of blocks on one body, the one with the later rows first.
std::vector<std::pair<std::size_t, std::size_t>> list_pairs(const std::vector<Block>& blocks) {
  std::vector<std::vector<std::size_t>> blocks_of_body;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto body = static_cast<std::size_t>(blocks[k].body);
    if (blocks_of_body.size() <= body) blocks_of_body.resize(body + 1);
    blocks_of_body[body].push_back(k);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::vector<std::size_t>& members : blocks_of_body) {
    for (const std::size_t p : members) {
      for (const std::size_t q : members) {
        if (blocks[p].row >= blocks[q].row) pairs.emplace_back(p, q);
      }
    }
  }
  return pairs;
}

}  // namespace

MultiplierSolver::MultiplierSolver(const BlockJacobian& jacobian, int num_constraints) {
  const std::vector<Block>& blocks = jacobian.blocks();
  std::size_t rows = 0, modal = 0;
  for (const Block& block : blocks) {
    row_offsets_.push_back(rows);
    modal_offsets_.push_back(modal);
    rows += static_cast<std::size_t>(block.num_rows);
    modal += static_cast<std::size_t>(block.num_rows * (block.num_columns - 3));
  }
  Y_.resize(rows);
  CY_.resize(rows);
  Z_.resize(modal);

  std::vector<std::pair<int, int>> entries;
  for (const auto& [p, q] : list_pairs(blocks)) {
    pairs_.push_back({.num_rows_p = blocks[p].num_rows,
                      .num_rows_q = blocks[q].num_rows,
                      .num_modes = blocks[p].num_columns - 3,
                      .row_p = row_offsets_[p],
                      .row_q = row_offsets_[q],
                      .modal_p = blocks[p].offset + 3,
                      .modal_q = modal_offsets_[q],
                      .first_place = entries.size()});
    for (int i = 0; i < blocks[p].num_rows; ++i) {
      for (int j = 0; j < blocks[q].num_rows; ++j) entries.emplace_back(blocks[p].row + i, blocks[q].row + j);
    }
  }
  factor_ = SparseCholesky(num_constraints, entries);
  for (const auto& [i, j] : entries) places_.push_back(i >= j ? factor_.place(i, j) : factor_.unused_place());
}

// Yᵢ·C⁻¹Yⱼ + G_fᵢ·Zⱼ for the rows i of p and j of q.
// @tparam num_rows, num_modes  of both blocks and of the body, where they are known beforehand; −1: any
template <int num_rows, int num_modes>
void MultiplierSolver::add_products(const Pair& pair, const double* jacobian_values) {
  const int rows_p = num_rows >= 0 ? num_rows : pair.num_rows_p;
  const int rows_q = num_rows >= 0 ? num_rows : pair.num_rows_q;
  const int modes = num_modes >= 0 ? num_modes : pair.num_modes;
  const Eigen::Vector3d* Y = Y_.data() + pair.row_p;
  const Eigen::Vector3d* CY = CY_.data() + pair.row_q;
  const int* place = places_.data() + pair.first_place;
  double* values = factor_.values().data();
  for (int i = 0; i < rows_p; ++i) {
    const double* G = jacobian_values + pair.modal_p + i * (3 + modes);
    for (int j = 0; j < rows_q; ++j) {
      const double* Z = Z_.data() + pair.modal_q + j * modes;
      double sum = Y[i][0] * CY[j][0] + Y[i][1] * CY[j][1] + Y[i][2] * CY[j][2];
      for (int m = 0; m < modes; ++m) sum += G[m] * Z[m];
      values[*place++] += sum;
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
      Eigen::Vector3d& Y = Y_[row_offsets_[k] + i];
      mass.reduce_row(jacobian.values(k) + i * static_cast<std::size_t>(block.num_columns), Y,
                      Z_.data() + modal_offsets_[k] + modes * i);
      CY_[row_offsets_[k] + i] = mass.solve_rigid(Y);
    }
  }
  std::fill(factor_.values().begin(), factor_.values().end(), 0.0);
  for (const Pair& pair : pairs_) {
    const bool revolute = pair.num_rows_p == 2 && pair.num_rows_q == 2;  // what most joints are
    if (revolute && pair.num_modes == 0)
      add_products<2, 0>(pair, jacobian.data());
    else if (revolute)
      add_products<2, -1>(pair, jacobian.data());
    else
      add_products<-1, -1>(pair, jacobian.data());
  }
  return factor_.factorise();
}

void MultiplierSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const {
  lambda = r;
  factor_.solve(lambda.data());
}

}  // namespace sprung::dynamics
