#include "fem/coupling.h"

#include <fmt/format.h>

#include <stdexcept>

namespace sprung::fem {

namespace {

// T: the identity without the rows of followers, which have the motions of their leaders instead.
Eigen::SparseMatrix<double> make_transformation(const std::vector<Coupling>& couplings,
                                                Eigen::Index num_freedoms) {
  std::vector<bool> follows(static_cast<std::size_t>(num_freedoms), false);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Coupling& coupling : couplings) {
    for (int i = 0; i < 3; ++i) {
      follows[static_cast<std::size_t>(3 * coupling.node + i)] = true;
      for (const Coupling::Leader& leader : coupling.leaders) {
        for (int j = 0; j < 3; ++j) {
          if (leader.motion(i, j) != 0.0)
            entries.emplace_back(3 * coupling.node + i, 3 * leader.node + j, leader.motion(i, j));
        }
      }
    }
  }
  for (int i = 0; i < static_cast<int>(num_freedoms); ++i) {
    if (!follows[static_cast<std::size_t>(i)]) entries.emplace_back(i, i, 1.0);
  }
  Eigen::SparseMatrix<double> T(num_freedoms, num_freedoms);
  T.setFromTriplets(entries.begin(), entries.end());
  return T;
}

}  // namespace

Coupling make_rigid_offset(const Eigen::Matrix2Xd& positions, int node, int leader) {
  const Eigen::Vector2d r = positions.col(node) - positions.col(leader);
  Coupling::Leader only{.node = leader};
  only.motion(0, 2) = -r.y();
  only.motion(1, 2) = r.x();
  return {.node = node, .leaders = {only}};
}

Coupling make_average(const Eigen::Matrix2Xd& positions, int node, const std::vector<int>& leaders,
                      const std::vector<double>& weights) {
  if (leaders.size() < 2 || weights.size() != leaders.size()) {
    throw std::invalid_argument(
        fmt::format("make_average: {} leaders with {} weights, expected at least 2 with one each",
                    leaders.size(), weights.size()));
  }
  double total = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    if (!(weights[i] > 0.0))
      throw std::invalid_argument(fmt::format("make_average: weight {} is not positive", weights[i]));
    total += weights[i];
    centre += weights[i] * positions.col(leaders[i]);
  }
  centre /= total;
  double second_moment = 0.0;
  for (std::size_t i = 0; i < leaders.size(); ++i)
    second_moment += weights[i] * (positions.col(leaders[i]) - centre).squaredNorm();
  const Eigen::Vector2d arm = positions.col(node) - centre;
  Coupling average{.node = node, .leaders = {}};
  for (std::size_t i = 0; i < leaders.size(); ++i) {
    const Eigen::Vector2d r = positions.col(leaders[i]) - centre;
    const Eigen::RowVector3d rotation = weights[i] / second_moment * Eigen::RowVector3d(-r.y(), r.x(), 0.0);
    Eigen::Matrix3d motion = Eigen::Matrix3d::Zero();
    motion(0, 0) = motion(1, 1) = weights[i] / total;
    motion.row(0) -= arm.y() * rotation;
    motion.row(1) += arm.x() * rotation;
    motion.row(2) = rotation;
    average.leaders.push_back({.node = leaders[i], .motion = motion});
  }
  return average;
}

Eigen::MatrixXd move_followers(const std::vector<Coupling>& couplings, Eigen::MatrixXd displacements) {
  for (const Coupling& coupling : couplings) {
    Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(3, displacements.cols());
    for (const Coupling::Leader& leader : coupling.leaders)
      moved += leader.motion * displacements.middleRows(3 * leader.node, 3);
    displacements.middleRows(3 * coupling.node, 3) = moved;
  }
  return displacements;
}

Eigen::MatrixXd move_loads_to_leaders(const std::vector<Coupling>& couplings, Eigen::MatrixXd loads) {
  for (const Coupling& coupling : couplings) {
    const Eigen::MatrixXd load = loads.middleRows(3 * coupling.node, 3);
    loads.middleRows(3 * coupling.node, 3).setZero();
    for (const Coupling::Leader& leader : coupling.leaders)
      loads.middleRows(3 * leader.node, 3) += leader.motion.transpose() * load;
  }
  return loads;
}

Eigen::SparseMatrix<double> eliminate_followers(const std::vector<Coupling>& couplings,
                                                const Eigen::SparseMatrix<double>& matrix) {
  const Eigen::SparseMatrix<double> T = make_transformation(couplings, matrix.rows());
  const Eigen::SparseMatrix<double> product = matrix * T;
  return T.transpose() * product;
}

}  // namespace sprung::fem
