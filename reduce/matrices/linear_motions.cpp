#include "reduce/matrices/linear_motions.h"

namespace sprung::reduce {

LinearMotions make_linear_motions(const MatrixBody& body, const Eigen::Vector2d& origin) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(body.stiffness.rows());
  LinearMotions motions{.along_x = zero, .along_y = zero, .rotation = zero, .places = zero};
  for (int node = 0; node < body.num_nodes(); ++node) {
    const Eigen::Vector2d r = body.node_positions.col(node) - origin;
    motions.along_x(3 * node) = motions.along_y(3 * node + 1) = 1.0;
    motions.rotation.segment<3>(3 * node) << -r.y(), r.x(), 1.0;
    motions.places.segment<3>(3 * node) << r.x(), r.y(), 0.0;
  }
  return motions;
}

Eigen::Vector2d calc_middle(const MatrixBody& body) {
  return 0.5 * (body.node_positions.rowwise().maxCoeff() + body.node_positions.rowwise().minCoeff());
}

}  // namespace sprung::reduce
