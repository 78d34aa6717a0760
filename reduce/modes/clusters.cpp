#include "reduce/modes/clusters.h"

#include <cmath>

namespace sprung::reduce {

Eigen::VectorXi find_clusters(const Eigen::VectorXd& omega_squared) {
  Eigen::VectorXi cluster(omega_squared.size());
  for (Eigen::Index i = 0; i < cluster.size(); ++i) {
    if (i == 0) {
      cluster(i) = 1;
      continue;
    }
    const double gap = 1.0 - std::sqrt(omega_squared(i - 1) / omega_squared(i));
    cluster(i) = cluster(i - 1) + (gap < kClusterGap ? 0 : 1);
  }
  return cluster;
}

ModeRange find_cluster_of(const Eigen::VectorXi& cluster, Eigen::Index mode) {
  ModeRange range{.begin = mode, .end = mode + 1};
  while (range.begin > 0 && cluster(range.begin - 1) == cluster(mode)) --range.begin;
  while (range.end < cluster.size() && cluster(range.end) == cluster(mode)) ++range.end;
  return range;
}

}  // namespace sprung::reduce
