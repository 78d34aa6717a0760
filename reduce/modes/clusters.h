#pragma once

#include <Eigen/Core>

namespace sprung::reduce {

/// Two neighbouring modes whose frequencies differ by less than this share belong to one cluster.
inline constexpr double kClusterGap = 1e-6;

/// Numbers the groups of equal frequencies.
///
/// @param omega_squared  n, ascending [rad²/s²]
/// @return n, from 1; a mode has its predecessor's number where (f₂ − f₁)/f₂ < kClusterGap
Eigen::VectorXi find_clusters(const Eigen::VectorXd& omega_squared);

/// Half-open range of modes, 0-based.
struct ModeRange {
  Eigen::Index begin = 0, end = 0;
  Eigen::Index size() const { return end - begin; }
};

/// The modes that share a number with the mode given. @param cluster as from find_clusters
ModeRange find_cluster_of(const Eigen::VectorXi& cluster, Eigen::Index mode);

}  // namespace sprung::reduce
