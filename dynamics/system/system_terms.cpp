#include "dynamics/system/system_terms.h"

#include <algorithm>
#include <set>

namespace sprung::dynamics {

namespace {

std::vector<MarkerState> make_marker_states(const Model& model) {
  std::vector<MarkerState> states;
  for (const Marker& marker : model.markers) states.push_back(make_marker_state(marker));
  return states;
}

}  // namespace

SystemTerms::SystemTerms(const Model& model, Markers scope)
    : model_(&model),
      q_(Eigen::VectorXd::Zero(model.num_coordinates)),
      v_(Eigen::VectorXd::Zero(model.num_coordinates)),
      rotations_(model.bodies.size()),
      nearby_rotations_(model.bodies.size()),
      markers_(make_marker_states(model)),
      masses_(model.bodies.begin(), model.bodies.end()),
      constraints_(model, markers_),
      forces_(model, masses_) {
  for (const Body& body : model.bodies) {
    if (!masses_[angles_.size()].is_constant()) varying_bodies_.push_back(angles_.size());
    angles_.push_back(body.first_coordinate + 2);
  }
  std::set<int> in_joints;
  std::vector<int> of_joints, others, idle;
  for (const auto& joint : model.joints) in_joints.insert({joint->marker_a, joint->marker_b});
  for (int i = 0; i < static_cast<int>(model.markers.size()); ++i) {
    if (model.markers[static_cast<std::size_t>(i)].body == kGround) continue;
    if (in_joints.count(i) > 0) {
      of_joints.push_back(i);
    } else if (scope == Markers::kAll ||
               std::binary_search(model.acting_markers.begin(), model.acting_markers.end(), i)) {
      others.push_back(i);
    } else {
      idle.push_back(i);
    }
  }
  joint_markers_ = MarkerSet(model, of_joints);
  other_markers_ = MarkerSet(model, others);
  idle_markers_ = MarkerSet(model, idle);
}

void SystemTerms::update_positions(double time, const Eigen::Ref<const Eigen::VectorXd>& q) {
  place_joints(time, q);
  place_others();
}

void SystemTerms::place_joints(double time, const Eigen::Ref<const Eigen::VectorXd>& q) {
  time_ = time;
  q_ = q;
  for (std::size_t b = 0; b < angles_.size(); ++b) rotations_[b] = nearby_rotations_[b].at(q_[angles_[b]]);
  joint_markers_.place(rotations_, q_, markers_);
  set_only(Term::kJointPositions);
}

void SystemTerms::place_others() {
  assert(has(Term::kJointPositions));
  other_markers_.place(rotations_, q_, markers_);
  set(Term::kPositions);
}

void SystemTerms::update_all_markers() {
  assert(has(Term::kVelocities));
  idle_markers_.place(rotations_, q_, markers_);
  idle_markers_.move(v_, markers_);
  set(Term::kAllMarkers);
}

Eigen::VectorXd SystemTerms::calc_metric() const {
  assert(has(Term::kMass));
  Eigen::VectorXd metric = Eigen::VectorXd::Ones(model_->num_coordinates);
  for (std::size_t b = 0; b < masses_.size(); ++b) {
    const Body& body = model_->bodies[b];
    for (int k = 0; k < body.num_coordinates(); ++k) metric[body.first_coordinate + k] = masses_[b].metric(k);
  }
  return metric;
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
  joint_markers_.move(v_, markers_);
  other_markers_.move(v_, markers_);
  reset(Term::kForces);
  reset(Term::kAccelerations);
  reset(Term::kAllMarkers);
  set(Term::kVelocities);
}

void SystemTerms::update_forces(std::span<const int> branches) {
  assert(has(Term::kPositions) && has(Term::kVelocities) && has(Term::kMass));
  forces_.update(
      {.time = time_, .q = q_, .v = v_, .rotations = rotations_, .masses = masses_, .markers = markers_},
      branches);
  reset(Term::kAccelerations);
  set(Term::kForces);
}

void SystemTerms::calc_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const {
  assert(has(Term::kJacobian) && has(Term::kForces));
  std::copy(forces_.wrenches().begin(), forces_.wrenches().end(), loads.begin());
  constraints_.add_joint_loads(lambda, loads);
}

void SystemTerms::choose_branches(std::span<int> branches) const {
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    model_->forces[f]->choose_branches(instant_of(f), model_->branches_of(f, branches));
  }
}

std::vector<int> SystemTerms::find_branches() const {
  std::vector<int> branches(static_cast<std::size_t>(model_->num_branches));
  choose_branches(branches);
  return branches;
}

Eigen::MatrixXd calc_marker_jacobian(const SystemTerms& terms, int marker) {
  const Model& model = terms.model();
  const Marker& point = model.markers[static_cast<std::size_t>(marker)];
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, model.num_coordinates);
  if (point.body == kGround) return jacobian;
  const Body& body = model.bodies[static_cast<std::size_t>(point.body)];
  const MarkerState& state = terms.markers()[static_cast<std::size_t>(marker)];
  const int first = body.first_coordinate;
  jacobian.block<2, 2>(0, first).setIdentity();
  jacobian.block<2, 1>(0, first + 2) = state.r_theta;
  jacobian(2, first + 2) = 1.0;
  jacobian.block(0, first + 3, 2, body.num_modes()) = state.r_eta();
  jacobian.block(2, first + 3, 1, body.num_modes()) = state.Phi.row(2);
  return jacobian;
}

}  // namespace sprung::dynamics
