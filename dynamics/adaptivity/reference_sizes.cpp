#include "dynamics/adaptivity/reference_sizes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

namespace {

constexpr double kSmallestDeflection = 1e-5;    // of the model's length scale
constexpr double kSmallestAcceleration = 1e-2;  // of gravity

}  // namespace

ReferenceSizes::ReferenceSizes(const Model& full, std::vector<int> points)
    : full_(&full), points_(std::move(points)), deflection_(kSmallestDeflection * full.length_scale) {
  const double gravity = std::max(full.gravity.norm(), full.length_scale);
  least_acceleration_ = kSmallestAcceleration * gravity;
  accelerations_.assign(points_.size(), least_acceleration_);
  present_.assign(points_.size(), Eigen::Vector2d::Zero());
  for (const int i : points_) {
    point_states_.push_back(make_marker_state(full.markers[static_cast<std::size_t>(i)]));
  }
  stack_shapes();
}

void ReferenceSizes::stack_shapes() {
  Eigen::Index most = 0;
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    std::vector<const Marker*> markers;
    for (const Marker& marker : full_->markers) {
      if (marker.body == static_cast<int>(b) && marker.Phi.cols() > 0) markers.push_back(&marker);
    }
    const auto rows = static_cast<Eigen::Index>(2 * markers.size());
    shapes_.emplace_back(rows, markers.empty() ? 0 : full_->bodies[b].num_modes());
    for (std::size_t i = 0; i < markers.size(); ++i) {
      shapes_.back().middleRows<2>(2 * static_cast<Eigen::Index>(i)) = markers[i]->Phi.topRows<2>();
    }
    most = std::max(most, rows);
  }
  deflections_ = Eigen::VectorXd::Zero(most);
}

void ReferenceSizes::update(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                            const Eigen::VectorXd& v_dot) {
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    if (shapes_[b].cols() == 0) continue;
    support::multiply(shapes_[b], q.data() + full_->bodies[b].first_coordinate + 3, deflections_.data());
    double square = 0.0;
    for (Eigen::Index i = 0; i < shapes_[b].rows(); i += 2)
      square = std::max(square, deflections_.segment<2>(i).squaredNorm());
    deflection_ = std::max(deflection_, std::sqrt(square));
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Marker& marker = full_->markers[static_cast<std::size_t>(points_[i])];
    if (marker.body == kGround) continue;
    const Body& body = full_->bodies[static_cast<std::size_t>(marker.body)];
    const int first = body.first_coordinate, size = body.num_coordinates();
    const FrameRotation rotation = FrameRotation::from_angle(q[first + 2]);
    calc_marker_position(marker, rotation, q.data() + first, point_states_[i]);
    calc_marker_velocity(marker, v.data() + first, point_states_[i]);
    present_[i] = calc_marker_acceleration(point_states_[i], v_dot.segment(first, size));
    accelerations_[i] = std::max(accelerations_[i], present_[i].norm());
  }
}

}  // namespace sprung::dynamics
