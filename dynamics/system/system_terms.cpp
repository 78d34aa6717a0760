#include "dynamics/system/system_terms.h"

#include <algorithm>
#include <numeric>

namespace sprung::dynamics {

SystemTerms::SystemTerms(const Model& model, Markers scope)
    : model_(&model),
      q_(Eigen::VectorXd::Zero(model.num_coordinates)),
      v_(Eigen::VectorXd::Zero(model.num_coordinates)),
      Q_(Eigen::VectorXd::Zero(model.num_coordinates)),
      rotations_(model.bodies.size()),
      wrenches_(model.markers.size()),
      joint_jacobians_(model.joints.size()),
      Phi_q_(model.num_constraints, model.num_coordinates) {
  if (scope == Markers::kActing) {
    kept_markers_ = model.acting_markers;
  } else {
    kept_markers_.resize(model.markers.size());
    std::iota(kept_markers_.begin(), kept_markers_.end(), 0);
  }
  for (const Body& body : model.bodies) masses_.emplace_back(body);
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    add_block(j, model.joints[j]->marker_a);
    add_block(j, model.joints[j]->marker_b);
  }
  for (const Marker& marker : model.markers) markers_.push_back(make_marker_state(marker));
}

void SystemTerms::update_positions(double time, const Eigen::Ref<const Eigen::VectorXd>& q) {
  time_ = time;
  q_ = q;
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    rotations_[b] = FrameRotation::from_angle(q_[model_->bodies[b].first_coordinate + 2]);
  }
  for (const int i : kept_markers_) place_marker(i);
}

void SystemTerms::adjust_positions(const Eigen::Ref<const Eigen::VectorXd>& q) {
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const int angle = model_->bodies[b].first_coordinate + 2;
    rotations_[b].turn_to(q[angle], q_[angle]);
  }
  q_ = q;
  for (const int i : kept_markers_) place_marker(i);
}

void SystemTerms::place_marker(int index) {
  const Marker& marker = model_->markers[static_cast<std::size_t>(index)];
  if (marker.body == kGround) return;
  const auto b = static_cast<std::size_t>(marker.body);
  const Body& body = model_->bodies[b];
  calc_marker_position(marker, rotations_[b], q_.segment(body.first_coordinate, body.num_coordinates()),
                       markers_[static_cast<std::size_t>(index)]);
}

void SystemTerms::move_marker(int index) {
  const Marker& marker = model_->markers[static_cast<std::size_t>(index)];
  if (marker.body == kGround) return;
  const auto b = static_cast<std::size_t>(marker.body);
  const Body& body = model_->bodies[b];
  calc_marker_velocity(marker, rotations_[b], v_.segment(body.first_coordinate, body.num_coordinates()),
                       markers_[static_cast<std::size_t>(index)]);
}

void SystemTerms::update_all_markers() {
  for (int i = 0; i < static_cast<int>(markers_.size()); ++i) {
    place_marker(i);
    move_marker(i);
  }
}

void SystemTerms::calc_residual(Eigen::Ref<Eigen::VectorXd> phi) const {
  JointVector residual;
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    joint.calc_residual(marker(joint.marker_a), marker(joint.marker_b), time_, residual);
    phi.segment(model_->joint_rows[j], residual.size()) = residual;
  }
}

void SystemTerms::add_block(std::size_t joint, int marker_index) {
  const int index = model_->markers[static_cast<std::size_t>(marker_index)].body;
  if (index == kGround) return;
  const Body& body = model_->bodies[static_cast<std::size_t>(index)];
  Phi_q_.add_block({.row = model_->joint_rows[joint],
                    .num_rows = model_->joints[joint]->num_constraints(),
                    .column = body.first_coordinate,
                    .num_columns = body.num_coordinates(),
                    .body = index});
}

// The blocks come in the order in which the constructor added them.
void SystemTerms::fill_block(const JointJacobian& G, int marker_index, std::size_t& next_block) {
  if (model_->markers[static_cast<std::size_t>(marker_index)].body == kGround) return;
  const MarkerState& state = marker(marker_index);
  double* value = Phi_q_.values(next_block++);
  for (int k = 0; k < G.rows(); ++k) {
    *value++ = G(k, 0);
    *value++ = G(k, 1);
    *value++ = G(k, 0) * state.r_theta.x() + G(k, 1) * state.r_theta.y() + G(k, 2);
    for (Eigen::Index n = 0; n < state.r_eta.cols(); ++n) {
      *value++ = G(k, 0) * state.r_eta(0, n) + G(k, 1) * state.r_eta(1, n) + G(k, 2) * state.angle_eta[n];
    }
  }
}

void SystemTerms::update_jacobian() {
  std::size_t next_block = 0;
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    JointJacobians& G = joint_jacobians_[j];
    joint.calc_jacobian(marker(joint.marker_a), marker(joint.marker_b), G.a, G.b);
    fill_block(G.a, joint.marker_a, next_block);
    fill_block(G.b, joint.marker_b, next_block);
  }
}

void SystemTerms::calc_time_rate(Eigen::Ref<Eigen::VectorXd> phi_t) const {
  if (!model_->has_motions) {
    phi_t.setZero();
    return;
  }
  JointVector rate;
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    joint.calc_time_rate(marker(joint.marker_a), marker(joint.marker_b), time_, rate);
    phi_t.segment(model_->joint_rows[j], rate.size()) = rate;
  }
}

void SystemTerms::update_mass() {
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    masses_[b].update(rotations_[b], q_.segment(body.first_coordinate + 3, body.num_modes()));
  }
}

void SystemTerms::update_velocities(const Eigen::Ref<const Eigen::VectorXd>& v) {
  v_ = v;
  for (const int i : kept_markers_) move_marker(i);
}

void SystemTerms::calc_gamma(Eigen::Ref<Eigen::VectorXd> gamma) const {
  JointVector drift;
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    const JointJacobians& G = joint_jacobians_[j];
    const MarkerState& a = marker(joint.marker_a);
    const MarkerState& b = marker(joint.marker_b);
    joint.calc_drift(a, b, time_, drift);
    for (int k = 0; k < drift.size(); ++k) {
      gamma[model_->joint_rows[j] + k] = -drift[k] - G.a(k, 0) * a.a_bias.x() - G.a(k, 1) * a.a_bias.y() -
                                         G.a(k, 2) * a.alpha_bias - G.b(k, 0) * b.a_bias.x() -
                                         G.b(k, 1) * b.a_bias.y() - G.b(k, 2) * b.alpha_bias;
    }
  }
}

void SystemTerms::add_wrench(int marker_index, const Wrench& wrench) {
  const Marker& point = model_->markers[static_cast<std::size_t>(marker_index)];
  if (point.body == kGround) return;
  const Body& body = model_->bodies[static_cast<std::size_t>(point.body)];
  const MarkerState& state = marker(marker_index);
  const int first = body.first_coordinate;
  Q_[first] += wrench.force.x();
  Q_[first + 1] += wrench.force.y();
  Q_[first + 2] += state.r_theta.dot(wrench.force) + wrench.torque;
  for (int n = 0; n < body.num_modes(); ++n) {
    Q_[first + 3 + n] += state.r_eta.col(n).dot(wrench.force) + state.angle_eta[n] * wrench.torque;
  }
}

void SystemTerms::update_forces(std::span<const int> branches) {
  for (const int i : model_->acting_markers) wrenches_[static_cast<std::size_t>(i)] = Wrench{};
  power_ = {};
  const Instant now = instant();
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    const Power power = force.add_wrenches(
        now, branches.subspan(static_cast<std::size_t>(model_->force_branches[f]), static_cast<std::size_t>(force.num_branches())),
        wrenches_);
    power_.dissipated += power.dissipated;
    power_.input += power.input;
  }
  Q_.setZero();
  for (const int i : model_->acting_markers) {
    const Wrench& wrench = wrenches_[static_cast<std::size_t>(i)];
    if (!wrench.force.isZero(0.0) || wrench.torque != 0.0) add_wrench(i, wrench);
  }
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const Body& body = model_->bodies[b];
    const int first = body.first_coordinate;
    const Eigen::Index n = body.num_modes();
    const auto eta = q_.segment(first + 3, n);
    const auto eta_dot = v_.segment(first + 3, n);
    auto Q = Q_.segment(first, 3 + n);
    add_gravity_forces(body, rotations_[b], model_->gravity, eta, Q);
    add_quadratic_velocity_forces(body, rotations_[b], v_[first + 2], eta, eta_dot, Q);
    if (body.stiffening) add_stiffening_forces(*body.stiffening, v_[first + 2], eta, eta_dot, Q);
    for (Eigen::Index i = 0; i < n; ++i) {
      double damping_force = 0.0;
      for (Eigen::Index j = 0; j < n; ++j) {
        Q[3 + i] -= body.stiffness(i, j) * eta[j];
        damping_force += body.damping(i, j) * eta_dot[j];
      }
      Q[3 + i] -= damping_force;
      power_.dissipated += damping_force * eta_dot[i];
    }
    for (const FadingForce& fading : body.fading) {
      const double value = fading.value(time_);
      Q[3 + fading.mode] += value;
      power_.input += value * eta_dot[fading.mode];
    }
  }
}

void SystemTerms::calc_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const {
  std::copy(wrenches_.begin(), wrenches_.end(), loads.begin());
  for (std::size_t j = 0; j < model_->joints.size(); ++j) {
    const Joint& joint = *model_->joints[j];
    const JointJacobians& G = joint_jacobians_[j];
    Wrench& on_a = loads[static_cast<std::size_t>(joint.marker_a)];
    Wrench& on_b = loads[static_cast<std::size_t>(joint.marker_b)];
    for (int k = 0; k < joint.num_constraints(); ++k) {
      const double multiplier = lambda[model_->joint_rows[j] + k];
      on_a.force -= multiplier * G.a.row(k).head<2>().transpose();
      on_a.torque -= multiplier * G.a(k, 2);
      on_b.force -= multiplier * G.b.row(k).head<2>().transpose();
      on_b.torque -= multiplier * G.b(k, 2);
    }
  }
}

void SystemTerms::choose_branches(std::span<int> branches) const {
  const Instant now = instant();
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    force.choose_branches(now, branches.subspan(static_cast<std::size_t>(model_->force_branches[f]),
                                                static_cast<std::size_t>(force.num_branches())));
  }
}

Energy calc_energy(const SystemTerms& terms, std::span<const int> branches) {
  const Model& model = terms.model();
  Energy energy;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::VectorXd q = terms.q().segment(body.first_coordinate, body.num_coordinates());
    const Eigen::VectorXd v = terms.v().segment(body.first_coordinate, body.num_coordinates());
    const Eigen::VectorXd eta = q.tail(body.num_modes());
    energy.kinetic += 0.5 * v.dot(terms.mass(b) * v);
    energy.strain += 0.5 * eta.dot(body.stiffness * eta);
    const Eigen::Vector2d moment = FrameRotation::from_angle(q[2]) * calc_first_moment(body, eta);
    energy.gravity -= model.gravity.dot(body.mass * q.head<2>() + moment);
  }
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    energy.spring += force.calc_stored_energy(
        terms.instant(), branches.subspan(static_cast<std::size_t>(model.force_branches[f]),
                                          static_cast<std::size_t>(force.num_branches())));
  }
  return energy;
}

}  // namespace sprung::dynamics
