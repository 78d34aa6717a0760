#include "dynamics/system/multiplier_solver.h"

#include <algorithm>
#include <span>
#include <utility>

namespace sprung::dynamics {

namespace {

using Block = BlockJacobian::Block;

// The blocks on each body.
std::vector<std::vector<std::size_t>> group_by_body(const std::vector<Block>& blocks) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto body = static_cast<std::size_t>(blocks[k].body);
    if (groups.size() <= body) groups.resize(body + 1);
    groups[body].push_back(k);
  }
  return groups;
}

struct Place {
  int node = -1;
  int row = 0;  // in the node
};
struct Nodes {
  std::vector<int> num_rows;  // of each
  std::vector<Place> places;  // of the constraints
};

Nodes make_nodes(const std::vector<Block>& blocks, int num_constraints) {
  Nodes all;
  all.places.resize(static_cast<std::size_t>(num_constraints));
  const auto add = [&](int first, int num_rows) {
    for (int i = 0; i < num_rows; ++i) {
      if (i % 2 == 0) all.num_rows.push_back(0);
      Place& place = all.places[static_cast<std::size_t>(first + i)];
      place.node = static_cast<int>(all.num_rows.size()) - 1;
      place.row = all.num_rows.back()++;
    }
  };
  for (const Block& block : blocks) {  // the blocks of a joint's other body use the same ones
    if (all.places[static_cast<std::size_t>(block.row)].node < 0) add(block.row, block.num_rows);
  }
  for (int i = 0; i < num_constraints; ++i) {  // without a body: a zero, which makes the matrix singular
    if (all.places[static_cast<std::size_t>(i)].node < 0) add(i, 1);
  }
  return all;
}

}  // namespace

MultiplierSolver::MultiplierSolver(const BlockJacobian& jacobian, int num_constraints) {
  const std::vector<Block>& blocks = jacobian.blocks();
  const Nodes all = make_nodes(blocks, num_constraints);
  std::vector<std::pair<int, int>> couplings;
  const std::vector<std::vector<std::size_t>> groups = group_by_body(blocks);
  for (std::size_t body = 0; body < groups.size(); ++body) {
    if (groups[body].empty()) continue;
    const int num_columns = blocks[groups[body].front()].num_columns;
    BodyPart& part = parts_.emplace_back(
        BodyPart{.body = body, .num_columns = num_columns, .first_member = members_.size()});
    for (const std::size_t k : groups[body]) {
      for (int i = 0; i < blocks[k].num_rows; ++i) {
        const Place& place = all.places[static_cast<std::size_t>(blocks[k].row + i)];
        if (place.row == 1) {
          members_.back().num_rows = 2;
          continue;
        }
        members_.push_back({.node = place.node,
                            .num_rows = 1,
                            .source = blocks[k].offset + static_cast<std::size_t>(i * num_columns),
                            .value = U_.size()});
        U_.resize(U_.size() + static_cast<std::size_t>(num_columns), Eigen::Vector2d::Zero());
      }
    }
    part.last_member = members_.size();
    for (std::size_t p = part.first_member; p < part.last_member; ++p) {
      for (std::size_t q = part.first_member; q < part.last_member; ++q)
        couplings.emplace_back(members_[p].node, members_[q].node);
    }
    no_row_.resize(std::max(no_row_.size(), static_cast<std::size_t>(num_columns)), 0.0);
  }
  V_ = U_;
  const int num_nodes = static_cast<int>(all.num_rows.size());
  factor_ = BlockCholesky(num_nodes, couplings);
  for (BodyPart& part : parts_) list_products(part);
  for (int node = 0; node < num_nodes; ++node) {
    if (all.num_rows[static_cast<std::size_t>(node)] == 1) lone_.push_back(factor_.place(node, node));
  }
  constraints_.resize(all.num_rows.size(), {-1, -1});
  for (std::size_t i = 0; i < all.places.size(); ++i) {
    auto& [upper, lower] = constraints_[static_cast<std::size_t>(factor_.step(all.places[i].node))];
    (all.places[i].row == 0 ? upper : lower) = static_cast<int>(i);
  }
  work_.resize(all.num_rows.size());
}

// Of each pair of nodes the product whose rows the factor stores; both where a node is on a body twice.
void MultiplierSolver::list_products(BodyPart& part) {
  const std::span members(members_.data() + part.first_member, part.last_member - part.first_member);
  part.first_product = products_.size();
  for (const Member& p : members) {
    for (const Member& q : members) {
      if (factor_.step(p.node) < factor_.step(q.node)) continue;
      products_.push_back({.u = p.value, .v = q.value, .place = factor_.place(p.node, q.node)});
    }
  }
  part.last_product = products_.size();
}

void MultiplierSolver::add_products(const BodyPart& part) {
  Eigen::Matrix2d* blocks = factor_.blocks().data();
  for (std::size_t k = part.first_product; k < part.last_product; ++k) {
    const Product& product = products_[k];
    const Eigen::Vector2d* U = U_.data() + product.u;
    const Eigen::Vector2d* V = V_.data() + product.v;
    Eigen::Vector2d left = U[0] * V[0].x() + U[1] * V[1].x() + U[2] * V[2].x();
    Eigen::Vector2d right = U[0] * V[0].y() + U[1] * V[1].y() + U[2] * V[2].y();
    for (int m = 3; m < part.num_columns; ++m) {
      left += U[m] * V[m].x();
      right += U[m] * V[m].y();
    }
    blocks[product.place].col(0) += left;
    blocks[product.place].col(1) += right;
  }
}

bool MultiplierSolver::factorise(const BlockJacobian& jacobian, const std::vector<BodyMass>& masses) {
  std::fill(factor_.blocks().begin(), factor_.blocks().end(), Eigen::Matrix2d::Zero());
  for (const int place : lone_) factor_.blocks()[static_cast<std::size_t>(place)](1, 1) = 1.0;
  for (const BodyPart& part : parts_) {
    const BodyMass& mass = masses[part.body];
    for (std::size_t k = part.first_member; k < part.last_member; ++k) {
      const Member& member = members_[k];
      const double* upper = jacobian.data() + member.source;
      const double* lower = member.num_rows == 2 ? upper + part.num_columns : no_row_.data();
      mass.reduce_rows(upper, lower, U_.data() + member.value, V_.data() + member.value);
    }
    add_products(part);
  }
  return factor_.factorise();
}

void MultiplierSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const {
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const auto [upper, lower] = constraints_[k];
    work_[k] = {r[upper], lower >= 0 ? r[lower] : 0.0};
  }
  factor_.solve(work_.data());
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const auto [upper, lower] = constraints_[k];
    lambda[upper] = work_[k].x();
    if (lower >= 0) lambda[lower] = work_[k].y();
  }
}

}  // namespace sprung::dynamics
