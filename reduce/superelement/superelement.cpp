#include "reduce/superelement/superelement.h"

#include <algorithm>

namespace sprung::reduce {

std::string Superelement::kind_of(int mode) const {
  return kind.empty() ? kClampedVector : kind[static_cast<std::size_t>(mode)];
}

bool Superelement::has_free_basis() const {
  return std::any_of(kind.begin(), kind.end(), [](const std::string& one) { return one != kClampedVector; });
}

Eigen::Index find_reference_node(const Superelement& superelement) {
  Eigen::Index node = 0;
  superelement.node_positions.colwise().norm().minCoeff(&node);
  return node;
}

int find_point(const Superelement& superelement, const std::string& name) {
  for (const NamedPoint& point : superelement.points) {
    if (point.name == name) return point.node;
  }
  return -1;
}

}  // namespace sprung::reduce
