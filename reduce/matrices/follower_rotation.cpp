#include "reduce/matrices/follower_rotation.h"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

#include "tools/support/errors/input_error.h"

namespace sprung::reduce {

namespace {

// The spring is stiff against its surroundings, and not so stiff that rounding would show.
constexpr double kSpringShare = 100.0;

// The nodes that the stiffness connects a node with.
std::set<int> find_neighbours(const MatrixBody& body, int node) {
  std::set<int> neighbours;
  for (int axis = 0; axis < 2; ++axis) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(body.stiffness, 3 * node + axis); entry; ++entry) {
      const auto other = static_cast<int>(entry.row() / 3);
      if (other != node && other < body.num_nodes() && entry.row() % 3 != 2) neighbours.insert(other);
    }
  }
  return neighbours;
}

// The coefficients of ψ − w(u).
std::vector<std::pair<int, double>> make_follower(const MatrixBody& body, int node, double& spread) {
  std::vector<std::pair<int, double>> row{{3 * node + 2, 1.0}};
  const std::set<int> neighbours = find_neighbours(body, node);
  spread = 0.0;
  for (const int other : neighbours)
    spread += (body.node_positions.col(other) - body.node_positions.col(node)).squaredNorm();
  if (!(spread > 0.0)) {
    throw support::InputError(
        {.path = body.stiffness_path},
        fmt::format("node {} has no rotation and no other node is connected with it, whose "
                    "displacements could give it one",
                    body.node_ids[static_cast<std::size_t>(node)]));
  }
  for (const int other : neighbours) {
    const Eigen::Vector2d d = (body.node_positions.col(other) - body.node_positions.col(node)) / spread;
    row.insert(row.end(),
               {{3 * other, d.y()}, {3 * other + 1, -d.x()}, {3 * node, -d.y()}, {3 * node + 1, d.x()}});
  }
  return row;
}

}  // namespace

void hold_missing_freedoms(MatrixBody& body) {
  std::vector<Eigen::Triplet<double>> springs;
  const Eigen::VectorXd diagonal = body.stiffness.diagonal();
  int num_rotations = 0;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (body.is_given[static_cast<std::size_t>(i)]) continue;
    if (i >= 3 * body.num_nodes()) {
      springs.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal.maxCoeff());
      continue;
    }
    const auto node = static_cast<int>(i / 3);
    double spread = 0.0;
    const std::vector<std::pair<int, double>> row = make_follower(body, node, spread);
    const double stiffness = kSpringShare * diagonal.segment<2>(3 * node).maxCoeff() * spread;
    for (const auto& [a, of_a] : row) {
      for (const auto& [b, of_b] : row) springs.emplace_back(a, b, stiffness * of_a * of_b);
    }
    ++num_rotations;
  }
  if (springs.empty()) return;
  Eigen::SparseMatrix<double> added(diagonal.size(), diagonal.size());
  added.setFromTriplets(springs.begin(), springs.end());
  body.stiffness +=
      Eigen::SparseMatrix<double>(0.5 * (added + Eigen::SparseMatrix<double>(added.transpose())));
  if (num_rotations > 0) {
    body.remarks.push_back(
        fmt::format("{} nodes have no rotation in the matrices; each rotates as the nodes around "
                    "it do",
                    num_rotations));
  }
}

}  // namespace sprung::reduce
