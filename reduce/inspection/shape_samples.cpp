#include "reduce/inspection/shape_samples.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sprung::reduce {

namespace {

constexpr double kOnBody = 1e-6;  // of the radius

double calc_radius(const Superelement& s) {
  return s.node_positions.colwise().norm().maxCoeff();
}

// Place on an element, ξ from 0 to 1.
struct Place {
  Eigen::Index element = 0;
  double xi = 0.0;
};

std::optional<Place> find_place(const Superelement& s, const Eigen::Vector2d& position) {
  Place best;
  double nearest = kOnBody * calc_radius(s);
  bool found = false;
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const Eigen::Vector2d first = s.node_positions.col(s.elements(0, e));
    const Eigen::Vector2d along = s.node_positions.col(s.elements(1, e)) - first;
    const double xi = std::clamp((position - first).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (first + xi * along - position).norm();
    if (distance > nearest) continue;
    nearest = distance;
    best = {.element = e, .xi = xi};
    found = true;
  }
  return found ? std::optional<Place>(best) : std::nullopt;
}

// 2×n: axial linear, bending by the Hermite cubic of end displacements and rotations.
Eigen::MatrixXd interpolate(const Superelement& s, const Place& place) {
  const Eigen::Index first = 3 * s.elements(0, place.element), second = 3 * s.elements(1, place.element);
  const Eigen::Vector2d span =
      s.node_positions.col(s.elements(1, place.element)) - s.node_positions.col(s.elements(0, place.element));
  const double length = span.norm(), xi = place.xi;
  const Eigen::Vector2d tangent = span / length, normal(-tangent.y(), tangent.x());
  const Eigen::MatrixXd a = s.shapes.middleRows(first, 2), b = s.shapes.middleRows(second, 2);
  const Eigen::RowVectorXd u = (1.0 - xi) * tangent.transpose() * a + xi * tangent.transpose() * b;
  const Eigen::RowVectorXd w = (1.0 - 3.0 * xi * xi + 2.0 * xi * xi * xi) * normal.transpose() * a +
                               (3.0 * xi * xi - 2.0 * xi * xi * xi) * normal.transpose() * b +
                               length * (xi - 2.0 * xi * xi + xi * xi * xi) * s.shapes.row(first + 2) +
                               length * (xi * xi * xi - xi * xi) * s.shapes.row(second + 2);
  return tangent * u + normal * w;
}

// The displacements of a body at a place: along its elements or, of a body without elements, at its nodes.
std::optional<Eigen::MatrixXd> find_shapes(const Superelement& s, const Eigen::Vector2d& position) {
  if (s.elements.cols() > 0) {
    const std::optional<Place> place = find_place(s, position);
    return place ? std::optional<Eigen::MatrixXd>(interpolate(s, *place)) : std::nullopt;
  }
  Eigen::Index node = 0;
  const double distance = (s.node_positions.colwise() - position).colwise().norm().minCoeff(&node);
  if (distance > kOnBody * calc_radius(s)) return {};
  return Eigen::MatrixXd(s.shapes.middleRows(3 * node, 2));
}

// Half the length of the elements at each node; 1 of a body without elements.
Eigen::VectorXd calc_weights(const Superelement& s) {
  if (s.elements.cols() == 0) return Eigen::VectorXd::Ones(s.num_nodes());
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(s.num_nodes());
  for (Eigen::Index e = 0; e < s.elements.cols(); ++e) {
    const double length =
        (s.node_positions.col(s.elements(1, e)) - s.node_positions.col(s.elements(0, e))).norm();
    weights(s.elements(0, e)) += 0.5 * length;
    weights(s.elements(1, e)) += 0.5 * length;
  }
  return weights;
}

struct Rows {
  std::vector<Eigen::MatrixXd> of_nodes, of_other;  // 2×n each
  double share = 0.0;
};

// The nodes of `body` that lie on `other`, both bodies' displacements there.
Rows sample_nodes(const Superelement& body, const Superelement& other) {
  Rows rows;
  const Eigen::VectorXd weights = calc_weights(body);
  for (Eigen::Index node = 0; node < body.num_nodes(); ++node) {
    const std::optional<Eigen::MatrixXd> of_other = find_shapes(other, body.node_positions.col(node));
    if (!of_other) continue;
    const double weight = std::sqrt(weights(node));
    rows.of_nodes.emplace_back(weight * body.shapes.middleRows(3 * node, 2));
    rows.of_other.emplace_back(weight * *of_other);
  }
  rows.share = static_cast<double>(rows.of_nodes.size()) / body.num_nodes();
  return rows;
}

Eigen::MatrixXd stack(const std::vector<Eigen::MatrixXd>& first, const std::vector<Eigen::MatrixXd>& second,
                      Eigen::Index columns) {
  Eigen::MatrixXd matrix(2 * static_cast<Eigen::Index>(first.size() + second.size()), columns);
  Eigen::Index row = 0;
  for (const auto* blocks : {&first, &second}) {
    for (const Eigen::MatrixXd& block : *blocks) {
      matrix.middleRows(row, 2) = block;
      row += 2;
    }
  }
  return matrix;
}

}  // namespace

ShapeSamples sample_shapes(const Superelement& old_body, const Superelement& new_body) {
  const Rows old_nodes = sample_nodes(old_body, new_body);
  const Rows new_nodes = sample_nodes(new_body, old_body);
  return {.old_shapes = stack(old_nodes.of_nodes, new_nodes.of_other, old_body.shapes.cols()),
          .new_shapes = stack(old_nodes.of_other, new_nodes.of_nodes, new_body.shapes.cols()),
          .num_points = static_cast<int>(old_nodes.of_nodes.size() + new_nodes.of_nodes.size()),
          .share_of_old = old_nodes.share,
          .share_of_new = new_nodes.share};
}

}  // namespace sprung::reduce
