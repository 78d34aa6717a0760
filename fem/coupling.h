#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace sprung::fem {

/// A node whose displacements and rotation follow from those of others (fem, eq. 32). It has no freedoms of
/// its own; what acts on it acts on the nodes that it follows.
struct Coupling {
  struct Leader {
    int node = 0;                                          ///< 0-based
    Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();  ///< its part of the follower's (x, y, rotation)
  };
  int node = 0;  ///< 0-based, the one that follows
  std::vector<Leader> leaders;
};

/// A node that moves as if it were fixed to another one rigidly (fem, eq. 33).
/// @param positions  2×N [m]
Coupling make_rigid_offset(const Eigen::Matrix2Xd& positions, int node, int leader);

/// A node with the mean motion of others: their weighted mean displacement, and the rotation that fits their
/// displacements best (fem, eq. 34).
/// @param weights  one for each leader, > 0
/// @throws std::invalid_argument if there are less than two leaders, other than one weight for each, or a
/// weight is not positive
Coupling make_average(const Eigen::Matrix2Xd& positions, int node, const std::vector<int>& leaders,
                      const std::vector<double>& weights);

/// Displacements of all nodes, those of followers from those of the nodes that they follow.
/// @param displacements  3N×k, of which the followers' rows are replaced
Eigen::MatrixXd move_followers(const std::vector<Coupling>& couplings, Eigen::MatrixXd displacements);

/// Loads that do the same work without any on a follower. @param loads  3N×k
Eigen::MatrixXd move_loads_to_leaders(const std::vector<Coupling>& couplings, Eigen::MatrixXd loads);

/// Tᵀ A T, where T gives the displacements of all nodes by move_followers: rows and columns of followers are
/// zero.
/// @param matrix  3N×3N
Eigen::SparseMatrix<double> eliminate_followers(const std::vector<Coupling>& couplings,
                                                const Eigen::SparseMatrix<double>& matrix);

}  // namespace sprung::fem
