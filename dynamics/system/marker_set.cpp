#include "dynamics/system/marker_set.h"

#include <algorithm>

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

MarkerSet::MarkerSet(const Model& model, const std::vector<int>& markers) : model_(&model) {
  for (const int i : markers) {
    const auto index = static_cast<std::size_t>(i);
    const Marker& marker = model.markers[index];
    const auto b = static_cast<std::size_t>(marker.body);
    const Body& body = model.bodies[b];
    if (body.num_modes() == 0) {
      rigid_.push_back({index, b, body.first_coordinate, marker.p_BP, marker.alpha_BP});
      continue;
    }
    OnFlexibleBody& group = find_body(b);
    group.markers.push_back(index);
    group.has_second_order = marker.has_second_order();
  }
  for (OnFlexibleBody& group : flexible_) {
    const auto count = static_cast<Eigen::Index>(group.markers.size());
    group.shapes.resize(3 * count, model.bodies[group.body].num_modes());
    for (Eigen::Index k = 0; k < count; ++k)
      group.shapes.middleRows<3>(3 * k) = model.markers[group.markers[static_cast<std::size_t>(k)]].Phi;
    group.displacement = Eigen::VectorXd::Zero(3 * count);
  }
}

MarkerSet::OnFlexibleBody& MarkerSet::find_body(std::size_t body) {
  const auto found = std::find_if(flexible_.begin(), flexible_.end(),
                                  [body](const OnFlexibleBody& group) { return group.body == body; });
  if (found != flexible_.end()) return *found;
  return flexible_.emplace_back(OnFlexibleBody{.body = body,
                                               .first_coordinate = model_->bodies[body].first_coordinate,
                                               .markers = {},
                                               .shapes = {},
                                               .displacement = {},
                                               .has_second_order = false});
}

void MarkerSet::place(std::span<const FrameRotation> rotations, const Eigen::VectorXd& q,
                      std::span<MarkerState> states) {
  for (const OnRigidBody& one : rigid_) {
    const double* body_q = q.data() + one.first_coordinate;
    MarkerState& state = states[one.marker];
    state.angle = body_q[2] + one.alpha_BP;
    place_in_body(one.p_BP, rotations[one.body], body_q, state);
  }
  for (OnFlexibleBody& group : flexible_) {
    const double* body_q = q.data() + group.first_coordinate;
    support::multiply(group.shapes, body_q + 3, group.displacement.data());
    const double* displacement = group.displacement.data();
    for (const std::size_t marker : group.markers) {
      place_marker(model_->markers[marker], displacement, rotations[group.body], body_q, states[marker]);
      displacement += 3;
    }
  }
}

void MarkerSet::move(const Eigen::VectorXd& v, std::span<MarkerState> states) {
  for (const OnRigidBody& one : rigid_) move_with_body(v.data() + one.first_coordinate, states[one.marker]);
  for (OnFlexibleBody& group : flexible_) {
    const double* body_v = v.data() + group.first_coordinate;
    if (group.has_second_order) {
      for (const std::size_t marker : group.markers)
        calc_marker_velocity(model_->markers[marker], body_v, states[marker]);
      continue;
    }
    support::multiply(group.shapes, body_v + 3, group.displacement.data());
    const double* rate = group.displacement.data();
    for (const std::size_t marker : group.markers) {
      move_marker(rate, body_v, states[marker]);
      rate += 3;
    }
  }
}

}  // namespace sprung::dynamics
