#include "reduce/modes/largest_displacement.h"

#include <array>
#include <cmath>

namespace sprung::reduce {

namespace {

constexpr double kEqualDisplacement = 0.01;  // sizes nearer than this share count as equal
constexpr double kSamePosition = 1e-9;       // of the radius

// +1: a before b, −1: b before a, 0: the same.
int compare(double a, double b, double tolerance) {
  if (std::abs(a - b) <= tolerance) return 0;
  return a > b ? 1 : -1;
}

}  // namespace

Eigen::Index find_largest_displacement(const Eigen::MatrixXd& shapes,
                                       const Eigen::Matrix2Xd& node_positions) {
  constexpr std::array<Eigen::Index, 3> kOrder{1, 0, 2};  // y, x, rotation
  const double radius = node_positions.colwise().norm().maxCoeff();
  Eigen::VectorXd sizes = shapes.topRows(3 * node_positions.cols()).rowwise().norm();
  for (Eigen::Index node = 0; node < node_positions.cols(); ++node) sizes(3 * node + 2) *= radius;
  const double smallest = (1.0 - kEqualDisplacement) * sizes.maxCoeff();
  Eigen::Index best = -1, best_node = -1;
  for (Eigen::Index node = 0; node < node_positions.cols(); ++node) {
    if (best_node >= 0) {
      const int in_x = compare(node_positions(0, node), node_positions(0, best_node), kSamePosition * radius);
      const int in_y = compare(node_positions(1, node), node_positions(1, best_node), kSamePosition * radius);
      if (in_x < 0 || (in_x == 0 && in_y < 0)) continue;
    }
    for (const Eigen::Index component : kOrder) {
      if (sizes(3 * node + component) < smallest) continue;
      best = 3 * node + component;
      best_node = node;
      break;
    }
  }
  return best;
}

}  // namespace sprung::reduce
