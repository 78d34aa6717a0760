#include "reduce/inspection/shape_samples.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "reduce/reduction/inertia_invariants.h"

namespace sprung::reduce {

namespace {

constexpr double kOnBody = 1e-6;  // of the radius
constexpr double kAlike = 1e-4;  // of the largest displacement: of parts of a body that are joined at a place

double calc_radius(const Superelement& s) {
  return s.node_positions.colwise().norm().maxCoeff();
}

// Displacements of the vectors, 3N×n: of those of the free body about its mean axes, V = φ − R M_r⁻¹RᵀMφ,
// which do not depend on the reference node (reduce/basis, eq. 1). The rigid part of φ, which vanishes there,
// would make different modes look alike.
Eigen::MatrixXd calc_shapes(const Superelement& s) {
  Eigen::MatrixXd shapes = s.shapes;
  const Eigen::MatrixXd mass = calc_mass_matrix(s.inertia);
  const Eigen::MatrixXd motions =
      mass.topLeftCorner<3, 3>().ldlt().solve(mass.topRightCorner(3, shapes.cols()));
  for (Eigen::Index mode = 0; mode < shapes.cols(); ++mode) {
    if (s.kind_of(static_cast<int>(mode)) == kClampedVector) continue;
    const Eigen::Vector3d motion = motions.col(mode);
    for (Eigen::Index node = 0; node < s.num_nodes(); ++node) {
      const double x = s.node_positions(0, node), y = s.node_positions(1, node);
      shapes(3 * node, mode) -= motion[0] - y * motion[2];
      shapes(3 * node + 1, mode) -= motion[1] + x * motion[2];
      shapes(3 * node + 2, mode) -= motion[2];
    }
  }
  return shapes;
}

// How far the places of the new body are from those of the old one in the axes of each, because its reference
// node is another: if all points that both name are that far. Else 0.
Eigen::Vector2d find_offset(const Superelement& old_body, const Superelement& new_body) {
  std::optional<Eigen::Vector2d> offset;
  for (const NamedPoint& one : old_body.points) {
    for (const NamedPoint& other : new_body.points) {
      if (other.name != one.name) continue;
      const Eigen::Vector2d here =
          new_body.node_positions.col(other.node) - old_body.node_positions.col(one.node);
      if (offset && (here - *offset).norm() > kOnBody * calc_radius(old_body)) return {0.0, 0.0};
      if (!offset) offset = here;
    }
  }
  return offset.value_or(Eigen::Vector2d(0.0, 0.0));
}

// Place on an element, ξ from 0 to 1; of a body without elements a node.
struct Place {
  Eigen::Index element = 0;
  double xi = 0.0;
};

// The elements of a body, or the nodes of one without elements, in the order of their least x: those at a
// place stand next to each other.
class PlaceFinder {
 public:
  explicit PlaceFinder(const Superelement& s) : body_(s), tolerance_(kOnBody * calc_radius(s)) {
    const Eigen::Index num_items = s.elements.cols() > 0 ? s.elements.cols() : s.num_nodes();
    for (Eigen::Index item = 0; item < num_items; ++item) {
      const double first = s.node_positions(0, node(item, 0)), second = s.node_positions(0, node(item, 1));
      items_.emplace_back(std::min(first, second), item);
      extent_ = std::max(extent_, std::abs(second - first));
    }
    std::sort(items_.begin(), items_.end());
  }

  // All within the tolerance.
  std::vector<Place> find(const Eigen::Vector2d& position) const {
    std::vector<Place> places;
    const std::pair<double, Eigen::Index> least(position.x() - extent_ - tolerance_, 0);
    for (auto item = std::lower_bound(items_.begin(), items_.end(), least);
         item != items_.end() && item->first <= position.x() + tolerance_; ++item) {
      const Eigen::Vector2d first = body_.node_positions.col(node(item->second, 0));
      const Eigen::Vector2d along = body_.node_positions.col(node(item->second, 1)) - first;
      const double length_squared = along.squaredNorm(), share = (position - first).dot(along);
      const double xi = length_squared > 0.0 ? std::clamp(share / length_squared, 0.0, 1.0) : 0.0;
      const double distance = (first + xi * along - position).norm();
      if (distance <= tolerance_) places.push_back({.element = item->second, .xi = xi});
    }
    return places;
  }

 private:
  int node(Eigen::Index item, int end) const {
    return body_.elements.cols() > 0 ? body_.elements(end, item) : static_cast<int>(item);
  }

  const Superelement& body_;
  double tolerance_ = 0.0, extent_ = 0.0;  // of the longest element along x
  std::vector<std::pair<double, Eigen::Index>> items_;
};

// 2×n: axial linear, bending by the Hermite cubic of end displacements and rotations.
Eigen::MatrixXd interpolate(const Superelement& s, const Eigen::MatrixXd& shapes, const Place& place) {
  const Eigen::Index first = 3 * s.elements(0, place.element), second = 3 * s.elements(1, place.element);
  const Eigen::Vector2d span =
      s.node_positions.col(s.elements(1, place.element)) - s.node_positions.col(s.elements(0, place.element));
  const double length = span.norm(), xi = place.xi;
  const Eigen::Vector2d tangent = span / length, normal(-tangent.y(), tangent.x());
  const Eigen::MatrixXd a = shapes.middleRows(first, 2), b = shapes.middleRows(second, 2);
  const Eigen::RowVectorXd u = (1.0 - xi) * tangent.transpose() * a + xi * tangent.transpose() * b;
  const Eigen::RowVectorXd w = (1.0 - 3.0 * xi * xi + 2.0 * xi * xi * xi) * normal.transpose() * a +
                               (3.0 * xi * xi - 2.0 * xi * xi * xi) * normal.transpose() * b +
                               length * (xi - 2.0 * xi * xi + xi * xi * xi) * shapes.row(first + 2) +
                               length * (xi * xi * xi - xi * xi) * shapes.row(second + 2);
  return tangent * u + normal * w;
}

// 2×n: along the elements of a body or, without elements, at its nodes.
Eigen::MatrixXd calc_displacements(const Superelement& s, const Eigen::MatrixXd& shapes, const Place& place) {
  if (s.elements.cols() > 0) return interpolate(s, shapes, place);
  return shapes.middleRows(3 * place.element, 2);
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

// The number of the node at a place of a body, if there is one.
std::optional<std::int64_t> find_node_id(const Superelement& s, const Place& place) {
  if (s.elements.cols() == 0) return s.node_ids[static_cast<std::size_t>(place.element)];
  if (place.xi > 0.0 && place.xi < 1.0) return {};
  return s.node_ids[static_cast<std::size_t>(s.elements(place.xi == 0.0 ? 0 : 1, place.element))];
}

// 2×n: the displacements of a body where it has these places, of which one may be the node with this number.
// None where parts of the body that are not joined lie above each other, and no number tells them apart.
std::optional<Eigen::MatrixXd> find_displacements(const Superelement& s, const Eigen::MatrixXd& shapes,
                                                  const std::vector<Place>& places, std::int64_t node_id) {
  for (const Place& place : places) {
    if (find_node_id(s, place) == node_id) return calc_displacements(s, shapes, place);
  }
  std::optional<Eigen::MatrixXd> found;
  const double alike = kAlike * shapes.cwiseAbs().maxCoeff();
  for (const Place& place : places) {
    Eigen::MatrixXd here = calc_displacements(s, shapes, place);
    if (found && (here - *found).cwiseAbs().maxCoeff() > alike) return {};
    if (!found) found = std::move(here);
  }
  return found;
}

struct Rows {
  std::vector<Eigen::MatrixXd> of_nodes, of_other;  // 2×n each
  double share = 0.0;
};

// A body and what calc_shapes gives of it.
struct ShapedBody {
  const Superelement& body;
  const Eigen::MatrixXd& shapes;
};

// The nodes of a body whose place on another one is known, both bodies' displacements there.
// @param offset  of the other one's places from those of the body
Rows sample_nodes(const ShapedBody& of_nodes, const ShapedBody& of_other, const Eigen::Vector2d& offset) {
  const Superelement &body = of_nodes.body, &other = of_other.body;
  Rows rows;
  const Eigen::VectorXd weights = calc_weights(body);
  const PlaceFinder finder(other);
  for (Eigen::Index node = 0; node < body.num_nodes(); ++node) {
    const std::optional<Eigen::MatrixXd> displacements =
        find_displacements(other, of_other.shapes, finder.find(body.node_positions.col(node) + offset),
                           body.node_ids[static_cast<std::size_t>(node)]);
    if (!displacements) continue;
    const double weight = std::sqrt(weights(node));
    rows.of_nodes.emplace_back(weight * of_nodes.shapes.middleRows(3 * node, 2));
    rows.of_other.emplace_back(weight * *displacements);
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
  const Eigen::MatrixXd old_shapes = calc_shapes(old_body), new_shapes = calc_shapes(new_body);
  const ShapedBody before{old_body, old_shapes}, after{new_body, new_shapes};
  const Eigen::Vector2d offset = find_offset(old_body, new_body);
  const Rows old_nodes = sample_nodes(before, after, offset);
  const Rows new_nodes = sample_nodes(after, before, -offset);
  return {.old_shapes = stack(old_nodes.of_nodes, new_nodes.of_other, old_body.shapes.cols()),
          .new_shapes = stack(old_nodes.of_other, new_nodes.of_nodes, new_body.shapes.cols()),
          .num_points = static_cast<int>(old_nodes.of_nodes.size() + new_nodes.of_nodes.size()),
          .share_of_old = old_nodes.share,
          .share_of_new = new_nodes.share};
}

}  // namespace sprung::reduce
