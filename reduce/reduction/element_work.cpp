#include "reduce/reduction/element_work.h"

namespace sprung::reduce {

ElementWork calc_element_work(const Superelement& s) {
  return calc_element_work(s, s.resultants);
}

ElementWork calc_element_work(const Superelement& s, const Eigen::MatrixXd& resultants) {
  const Eigen::Index n = s.frequency_hz.size(), k = resultants.cols();
  ElementWork work{.axial = Eigen::MatrixXd::Zero(n, k), .bending = Eigen::MatrixXd::Zero(n, k)};
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const Eigen::Vector2d along =
        (s.node_positions.col(s.elements(1, e)) - s.node_positions.col(s.elements(0, e))).normalized();
    const Eigen::RowVector2d tangent = along.transpose();
    const Eigen::RowVector2d normal(-along.y(), along.x());
    for (Eigen::Index end = 0; end < 2; ++end) {
      const double sign = end == 0 ? -1.0 : 1.0;
      const Eigen::MatrixXd shape = s.shapes.middleRows(3 * s.elements(end, e), 3);
      const Eigen::MatrixXd force = resultants.middleRows(6 * e + 3 * end, 3);
      const Eigen::RowVectorXd u = tangent * shape.topRows<2>();
      const Eigen::RowVectorXd w = normal * shape.topRows<2>();
      work.axial += sign * u.transpose() * force.row(0);
      work.bending += sign * (w.transpose() * force.row(1) + shape.row(2).transpose() * force.row(2));
    }
  }
  return work;
}

}  // namespace sprung::reduce
