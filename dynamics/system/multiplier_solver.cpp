#include "dynamics/system/multiplier_solver.h"

#include <algorithm>
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
  for (const Block& block : blocks) {  // those of a joint's other body find them made
    if (all.places[static_cast<std::size_t>(block.row)].node < 0) add(block.row, block.num_rows);
  }
  for (int i = 0; i < num_constraints; ++i) {  // no body: zero, which makes the matrix singular
    if (all.places[static_cast<std::size_t>(i)].node < 0) add(i, 1);
  }
  return all;
}

}  // namespace

// What a node has on a body: two rows of U_ and V_.
struct MultiplierSolver::Member {
  int node;
  std::size_t value;
};

MultiplierSolver::MultiplierSolver(const BlockJacobian& jacobian, int num_constraints) {
  const std::vector<Block>& blocks = jacobian.blocks();
  const Nodes all = make_nodes(blocks, num_constraints);
  std::vector<std::vector<Member>> members;  // of each part
  std::vector<std::pair<int, int>> couplings;
  const std::vector<std::vector<std::size_t>> groups = group_by_body(blocks);
  for (std::size_t body = 0; body < groups.size(); ++body) {
    if (groups[body].empty()) continue;
    const int num_columns = blocks[groups[body].front()].num_columns;
    parts_.push_back({.body = body, .num_columns = num_columns, .first_row = rows_.size()});
    members.emplace_back();
    for (const std::size_t k : groups[body]) {
      for (int i = 0; i < blocks[k].num_rows; ++i) {
        const Place& place = all.places[static_cast<std::size_t>(blocks[k].row + i)];
        if (place.row == 0) {
          members.back().push_back({place.node, U_.size()});
          U_.resize(U_.size() + 2 * static_cast<std::size_t>(num_columns), 0.0);
        }
        rows_.push_back({.source = blocks[k].offset + static_cast<std::size_t>(i * num_columns),
                         .value = members.back().back().value + static_cast<std::size_t>(place.row)});
      }
    }
    parts_.back().last_row = rows_.size();
    for (const Member& p : members.back()) {
      for (const Member& q : members.back()) couplings.emplace_back(p.node, q.node);
    }
  }
  V_.resize(U_.size(), 0.0);
  const int num_nodes = static_cast<int>(all.num_rows.size());
  factor_ = BlockCholesky(num_nodes, couplings);
  for (std::size_t k = 0; k < parts_.size(); ++k) list_products(members[k], parts_[k]);
  for (int node = 0; node < num_nodes; ++node) {
    if (all.num_rows[static_cast<std::size_t>(node)] == 1) lone_.push_back(factor_.place(node, node));
  }
  for (const Place& place : all.places) {
    places_.push_back(static_cast<std::size_t>(2 * factor_.step(place.node) + place.row));
  }
  work_.resize(2 * all.num_rows.size());
}

// Of each pair the one whose rows the factor stores; of one node that is twice on a body, both.
void MultiplierSolver::list_products(const std::vector<Member>& members, BodyPart& part) {
  part.first_product = products_.size();
  for (const Member& p : members) {
    for (const Member& q : members) {
      if (factor_.step(p.node) < factor_.step(q.node)) continue;
      products_.push_back({.u = p.value, .v = q.value, .place = factor_.place(p.node, q.node)});
    }
  }
  part.last_product = products_.size();
}

// @tparam num_columns  of the body, where it is known beforehand; −1: any
template <int num_columns>
void MultiplierSolver::add_products(const BodyPart& part) {
  const int columns = num_columns >= 0 ? num_columns : part.num_columns;
  Eigen::Matrix2d* blocks = factor_.blocks().data();
  for (std::size_t k = part.first_product; k < part.last_product; ++k) {
    const Product& product = products_[k];
    const Eigen::Map<const Eigen::Matrix2Xd> U(U_.data() + product.u, 2, columns);
    const Eigen::Map<const Eigen::Matrix2Xd> V(V_.data() + product.v, 2, columns);
    Eigen::Vector2d left = U.col(0) * V(0, 0), right = U.col(0) * V(1, 0);
    for (int m = 1; m < columns; ++m) {
      left += U.col(m) * V(0, m);
      right += U.col(m) * V(1, m);
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
    for (std::size_t k = part.first_row; k < part.last_row; ++k) {
      mass.reduce_row(jacobian.data() + rows_[k].source, U_.data() + rows_[k].value,
                      V_.data() + rows_[k].value);
    }
    if (part.num_columns == 3)
      add_products<3>(part);
    else
      add_products<-1>(part);
  }
  return factor_.factorise();
}

void MultiplierSolver::solve(const Eigen::VectorXd& r, Eigen::VectorXd& lambda) const {
  for (std::size_t i = 0; i < places_.size(); ++i) work_[places_[i]] = r[static_cast<Eigen::Index>(i)];
  factor_.solve(work_.data());
  for (std::size_t i = 0; i < places_.size(); ++i) lambda[static_cast<Eigen::Index>(i)] = work_[places_[i]];
}

}  // namespace sprung::dynamics
