#include "dynamics/section_loads/body_loads.h"

#include <algorithm>

#include "dynamics/bodies/body_equations.h"

namespace sprung::dynamics {

namespace {

constexpr Eigen::Index kFrameLoads = 4;

}  // namespace

BodyLoads::BodyLoads(const Model& model, int body, const reduce::Superelement& superelement,
                     const std::vector<VehiclePoint>& points)
    : first_(model.bodies[static_cast<std::size_t>(body)].first_coordinate),
      mass_(superelement.inertia.mass),
      gravity_(model.gravity) {
  for (const int i : model.acting_markers) {
    const auto marker = static_cast<std::size_t>(i);
    const VehiclePoint& point = points[marker];
    // What acts on the frame acts on the node at its origin, which holds the body where unit loads are
    // applied.
    if (point.body != body || point.kind == VehiclePoint::Kind::kFixed) continue;
    const auto named = std::find_if(superelement.points.begin(), superelement.points.end(),
                                    [&](const reduce::NamedPoint& one) { return one.node == point.node; });
    const bool is_center = point.kind == VehiclePoint::Kind::kCenterOfMass;
    markers_.push_back(
        {marker, is_center ? -1 : static_cast<int>(named - superelement.points.begin()), point.offset});
  }
  coefficients_ = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(markers_.size()) + kFrameLoads);
}

Eigen::MatrixXd BodyLoads::combine(const Eigen::MatrixXd& point_load,
                                   const Eigen::MatrixXd& acceleration) const {
  Eigen::MatrixXd combined = Eigen::MatrixXd::Zero(acceleration.rows(), size());
  Eigen::Index column = 0;
  for (const LoadedMarker& marker : markers_) {
    auto three = combined.middleCols<3>(column);
    column += 3;
    if (marker.point < 0) {
      // The point moves with the mean of the body's mass, so a force on it is spread as the mass is.
      three.leftCols<2>() = -acceleration.leftCols<2>() / mass_;
      continue;
    }
    three = point_load.middleCols<3>(3 * marker.point);
    three.col(0) -= marker.offset.y() * three.col(2);
    three.col(1) += marker.offset.x() * three.col(2);
  }
  combined.rightCols<kFrameLoads>() = acceleration;
  return combined;
}

void BodyLoads::update(std::span<const Wrench> loads, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                       const Eigen::VectorXd& v_dot) {
  const FrameRotation rotation = FrameRotation::from_angle(q[first_ + 2]);
  Eigen::Index at = 0;
  for (const LoadedMarker& marker : markers_) {
    const Wrench& load = loads[marker.marker];
    coefficients_.segment<2>(at) = rotation.transposed_times(load.force);
    coefficients_[at + 2] = load.torque;
    at += 3;
  }
  const double rate = v[first_ + 2];
  coefficients_.segment<2>(at) = rotation.transposed_times(v_dot.segment<2>(first_) - gravity_);
  coefficients_[at + 2] = v_dot[first_ + 2];
  coefficients_[at + 3] = rate * rate;
}

}  // namespace sprung::dynamics
