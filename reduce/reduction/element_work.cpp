#include "reduce/reduction/element_work.h"

#include <algorithm>

#include "reduce/factors/row_major.h"

namespace sprung::reduce {

namespace {

using Strided = Eigen::Map<const RowMajorMatrix, 0, Eigen::OuterStride<>>;

constexpr Eigen::Index kElementsAtOnce = 256;

// Displacements of the elements' ends along and across them, and rotations, against their outward normals at
// the first end: the rows of the resultants, 6×count.
RowMajorMatrix calc_end_motions(const Superelement& s, const RowMajorMatrix& shapes, Eigen::Index begin,
                                Eigen::Index count) {
  RowMajorMatrix motions(6 * count, shapes.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index e = begin + i;
    const Eigen::Vector2d along =
        (s.node_positions.col(s.elements(1, e)) - s.node_positions.col(s.elements(0, e))).normalized();
    for (Eigen::Index end = 0; end < 2; ++end) {
      const double sign = end == 0 ? -1.0 : 1.0;
      const auto shape = shapes.middleRows(3 * s.elements(end, e), 3);
      const Eigen::Index row = 6 * i + 3 * end;
      motions.row(row) = sign * along.x() * shape.row(0) + sign * along.y() * shape.row(1);
      motions.row(row + 1) = sign * along.x() * shape.row(1) - sign * along.y() * shape.row(0);
      motions.row(row + 2) = sign * shape.row(2);
    }
  }
  return motions;
}

}  // namespace

ElementWork calc_element_work(const Superelement& s) {
  return calc_element_work(s, s.resultants);
}

ElementWork calc_element_work(const Superelement& s, const support::RowMatrix& resultants) {
  const Eigen::Index n = s.frequency_hz.size(), k = resultants.cols(), num_elements = s.elements.cols();
  ElementWork work{.axial = Eigen::MatrixXd::Zero(n, k), .bending = Eigen::MatrixXd::Zero(n, k)};
  const RowMajorMatrix shapes = s.shapes;
  for (Eigen::Index begin = 0; begin < num_elements; begin += kElementsAtOnce) {
    const Eigen::Index count = std::min(kElementsAtOnce, num_elements - begin);
    const RowMajorMatrix motions = calc_end_motions(s, shapes, begin, count);
    const auto every_third = [count](const RowMajorMatrix& rows, Eigen::Index first) {
      return Strided(rows.data() + first * rows.cols(), 2 * count, rows.cols(),
                     Eigen::OuterStride<>(3 * rows.cols()));
    };
    const Eigen::Index first = 6 * begin;
    work.axial.noalias() += every_third(motions, 0).transpose() * every_third(resultants, first);
    work.bending.noalias() += every_third(motions, 1).transpose() * every_third(resultants, first + 1);
    work.bending.noalias() += every_third(motions, 2).transpose() * every_third(resultants, first + 2);
  }
  return work;
}

}  // namespace sprung::reduce
