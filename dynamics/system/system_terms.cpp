#include "dynamics/system/system_terms.h"

#include <algorithm>
#include <set>

namespace sprung::dynamics {

SystemTerms::SystemTerms(const Model& model, Markers scope)
    : model_(&model),
      q_(Eigen::VectorXd::Zero(model.num_coordinates)),
      v_(Eigen::VectorXd::Zero(model.num_coordinates)),
      Q_(Eigen::VectorXd::Zero(model.num_coordinates)),
      rotations_(model.bodies.size()),
      nearby_rotations_(model.bodies.size()),
      wrenches_(model.markers.size()),
      Phi_q_(model.num_constraints, model.num_coordinates) {
  for (const Body& body : model.bodies) {
    angles_.push_back(body.first_coordinate + 2);
    masses_.emplace_back(body);
    if (masses_.back().is_constant())
      constant_bodies_.push_back({body.first_coordinate, body.mass});
    else
      varying_bodies_.push_back(masses_.size() - 1);
  }
  for (const Marker& marker : model.markers) markers_.push_back(make_marker_state(marker));
  for (const int i : model.acting_markers) {
    if (model.markers[static_cast<std::size_t>(i)].body != kGround) acting_markers_.push_back(find_body(i));
  }
  std::set<int> in_joints;
  for (const auto& joint : model.joints) in_joints.insert({joint->marker_a, joint->marker_b});
  for (int i = 0; i < static_cast<int>(model.markers.size()); ++i) {
    if (model.markers[static_cast<std::size_t>(i)].body == kGround) continue;
    if (in_joints.count(i) > 0) {
      joint_markers_.push_back(find_body(i));
    } else if (scope == Markers::kAll ||
               std::binary_search(model.acting_markers.begin(), model.acting_markers.end(), i)) {
      other_markers_.push_back(find_body(i));
    }
  }
  for (std::size_t j = 0; j < model.joints.size(); ++j) add_joint(j);
}

SystemTerms::MovingMarker SystemTerms::find_body(int marker_index) const {
  const Marker& marker = model_->markers[static_cast<std::size_t>(marker_index)];
  const auto b = static_cast<std::size_t>(marker.body);
  const Body& body = model_->bodies[b];
  return {.marker = static_cast<std::size_t>(marker_index),
          .body = b,
          .first_coordinate = body.first_coordinate,
          .num_coordinates = body.num_coordinates(),
          .p_BP = marker.p_BP,
          .alpha_BP = marker.alpha_BP};
}

void SystemTerms::update_positions(double time, const Eigen::Ref<const Eigen::VectorXd>& q) {
  place_joints(time, q);
  place_others();
}

void SystemTerms::place_joints(double time, const Eigen::Ref<const Eigen::VectorXd>& q) {
  time_ = time;
  q_ = q;
  for (std::size_t b = 0; b < angles_.size(); ++b) rotations_[b] = nearby_rotations_[b].at(q_[angles_[b]]);
  place_markers(joint_markers_);
  set_only(Term::kJointPositions);
}

void SystemTerms::place_others() {
  assert(has(Term::kJointPositions));
  place_markers(other_markers_);
  set(Term::kPositions);
}

void SystemTerms::place_markers(std::span<const MovingMarker> markers) {
  for (const MovingMarker& moving : markers) {
    const FrameRotation& rotation = rotations_[moving.body];
    const double* q = q_.data() + moving.first_coordinate;
    MarkerState& state = markers_[moving.marker];
    if (!moving.is_rigid()) {
      calc_marker_position(model_->markers[moving.marker], rotation, q, state);
      continue;
    }
    state.angle = q[2] + moving.alpha_BP;
    place_in_body(moving.p_BP, rotation, q, state);
  }
}

void SystemTerms::move_markers(std::span<const MovingMarker> markers) {
  for (const MovingMarker& moving : markers) {
    const double* v = v_.data() + moving.first_coordinate;
    MarkerState& state = markers_[moving.marker];
    if (moving.is_rigid())
      move_with_body(v, state);
    else
      calc_marker_velocity(model_->markers[moving.marker], v, state);
  }
}

void SystemTerms::update_all_markers() {
  assert(has(Term::kVelocities));
  for (int i = 0; i < static_cast<int>(markers_.size()); ++i) {
    if (model_->markers[static_cast<std::size_t>(i)].body == kGround) continue;
    const MovingMarker moving = find_body(i);
    place_markers({&moving, 1});
    move_markers({&moving, 1});
  }
  set(Term::kAllMarkers);
}

void SystemTerms::calc_residual(Eigen::Ref<Eigen::VectorXd> phi) const {
  assert(has(Term::kJointPositions));
  JointVector residual;
  for (const JointTerms& terms : joints_) {
    terms.joint->calc_residual(markers_[terms.a.marker], markers_[terms.b.marker], time_, residual);
    for (int k = 0; k < terms.num_rows; ++k) phi[terms.row + k] = residual[k];
  }
}

void SystemTerms::add_joint(std::size_t index) {
  const Joint& joint = *model_->joints[index];
  const bool is_constant = joint.has_constant_jacobian();
  JointTerms terms{.joint = &joint,
                   .row = model_->joint_rows[index],
                   .num_rows = joint.num_constraints(),
                   .is_constant = is_constant,
                   .drifts = !is_constant || !joint.time_functions().empty(),
                   .a = {static_cast<std::size_t>(joint.marker_a), {}, -1},
                   .b = {static_cast<std::size_t>(joint.marker_b), {}, -1}};
  if (is_constant)
    joint.calc_jacobian(markers_[terms.a.marker], markers_[terms.b.marker], terms.a.G, terms.b.G);
  add_block(terms, terms.a);
  add_block(terms, terms.b);
  if (is_constant)
    fill_once(terms);
  else
    filled_joints_.push_back(joints_.size());
  joints_.push_back(terms);
}

void SystemTerms::fill_once(const JointTerms& terms) {
  for (const JointSide* side : {&terms.a, &terms.b}) {
    if (side->block < 0) continue;
    fill_block(*side);
    const BlockJacobian::Block& block = Phi_q_.blocks()[static_cast<std::size_t>(side->block)];
    for (int k = 0; k < block.num_rows; ++k) {
      turning_rows_.push_back({.value = block.offset + static_cast<std::size_t>(k * block.num_columns + 2),
                               .marker = side->marker,
                               .G = {side->G(k, 0), side->G(k, 1), side->G(k, 2)}});
    }
  }
}

void SystemTerms::add_block(const JointTerms& terms, JointSide& side) {
  const int index = model_->markers[side.marker].body;
  if (index == kGround) return;
  const Body& body = model_->bodies[static_cast<std::size_t>(index)];
  const std::size_t block = Phi_q_.add_block({.row = terms.row,
                                              .num_rows = terms.num_rows,
                                              .column = body.first_coordinate,
                                              .num_columns = body.num_coordinates(),
                                              .body = index});
  side.block = static_cast<std::ptrdiff_t>(block);
  if (!terms.is_constant) return;
  for (int k = 0; k < terms.num_rows; ++k) {
    for (int j = 0; j < 2; ++j) {  // what moves along with the frame's x and y
      if (side.G(k, j) == 0.0) Phi_q_.mark_zero(block, k, j);
    }
  }
}

// What of a row of the Jacobian changes with the state: by the angle, and by the modes.
inline void SystemTerms::fill_turning(const MarkerRow& G, const MarkerState& state, double* values) {
  values[0] = G.by_theta(state);
  if (state.Phi.cols() > 0) fill_modal(G, state, values + 1);
}

void SystemTerms::fill_modal(const MarkerRow& G, const MarkerState& state, double* values) {
  const MarkerRow in_body = G.in_body(state.rotation);
  const double* shape = state.Phi.data();
  for (Eigen::Index k = 0; k < state.Phi.cols(); ++k, shape += 3) values[k] = in_body.by_mode(shape);
}

void SystemTerms::fill_block(const JointSide& side) {
  if (side.block < 0) return;
  const MarkerState& state = markers_[side.marker];
  const Eigen::Index num_modes = state.Phi.cols();
  double* value = Phi_q_.values(static_cast<std::size_t>(side.block));
  for (Eigen::Index k = 0; k < side.G.rows(); ++k, value += 3 + num_modes) {
    value[0] = side.G(k, 0);
    value[1] = side.G(k, 1);
    fill_turning({side.G(k, 0), side.G(k, 1), side.G(k, 2)}, state, value + 2);
  }
}

void SystemTerms::update_jacobian() {
  assert(has(Term::kJointPositions));
  double* values = Phi_q_.data();
  for (const TurningRow& row : turning_rows_) {
    fill_turning(row.G, markers_[row.marker], values + row.value);
  }
  for (const std::size_t joint : filled_joints_) {
    JointTerms& terms = joints_[joint];
    if (!terms.is_constant) {
      terms.joint->calc_jacobian(markers_[terms.a.marker], markers_[terms.b.marker], terms.a.G, terms.b.G);
    }
    fill_block(terms.a);
    fill_block(terms.b);
  }
  set(Term::kJacobian);
}

void SystemTerms::calc_time_rate(Eigen::Ref<Eigen::VectorXd> phi_t) const {
  assert(has(Term::kJointPositions));
  if (!model_->has_motions) {
    phi_t.setZero();
    return;
  }
  JointVector rate;
  for (const JointTerms& terms : joints_) {
    terms.joint->calc_time_rate(markers_[terms.a.marker], markers_[terms.b.marker], time_, rate);
    for (int k = 0; k < terms.num_rows; ++k) phi_t[terms.row + k] = rate[k];
  }
}

void SystemTerms::update_mass() {
  assert(has(Term::kJointPositions));
  for (const std::size_t b : varying_bodies_) {
    const Body& body = model_->bodies[b];
    masses_[b].update(rotations_[b], q_.segment(body.first_coordinate + 3, body.num_modes()));
  }
  set(Term::kMass);
}

void SystemTerms::update_velocities(const Eigen::Ref<const Eigen::VectorXd>& v) {
  assert(has(Term::kPositions));
  v_ = v;
  move_markers(joint_markers_);
  move_markers(other_markers_);
  reset(Term::kForces);
  reset(Term::kAllMarkers);
  set(Term::kVelocities);
}

void SystemTerms::calc_gamma(Eigen::Ref<Eigen::VectorXd> gamma) const {
  assert(has(Term::kJacobian) && has(Term::kVelocities));
  JointVector drift;
  for (const JointTerms& terms : joints_) {
    const MarkerState& a = markers_[terms.a.marker];
    const MarkerState& b = markers_[terms.b.marker];
    for (int k = 0; k < terms.num_rows; ++k) {
      gamma[terms.row + k] =
          -(terms.a.G(k, 0) * a.a_bias.x() + terms.a.G(k, 1) * a.a_bias.y() + terms.a.G(k, 2) * a.alpha_bias +
            terms.b.G(k, 0) * b.a_bias.x() + terms.b.G(k, 1) * b.a_bias.y() + terms.b.G(k, 2) * b.alpha_bias);
    }
    if (!terms.drifts) continue;
    terms.joint->calc_drift(a, b, time_, drift);
    for (int k = 0; k < terms.num_rows; ++k) gamma[terms.row + k] -= drift[k];
  }
}

}  // namespace sprung::dynamics
