#include "dynamics/system/system_forces.h"

namespace sprung::dynamics {

SystemForces::SystemForces(const Model& model, const std::vector<BodyMass>& masses)
    : model_(&model), wrenches_(model.markers.size()), Q_(Eigen::VectorXd::Zero(model.num_coordinates)) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (masses[b].is_constant())
      constant_bodies_.push_back({model.bodies[b].first_coordinate, model.bodies[b].mass});
    else
      varying_bodies_.push_back({b, model.bodies[b].first_coordinate, BodyForces(model.bodies[b])});
  }
  for (const int i : model.acting_markers) {
    const auto marker = static_cast<std::size_t>(i);
    if (model.markers[marker].body == kGround) continue;
    const Body& body = model.bodies[static_cast<std::size_t>(model.markers[marker].body)];
    acting_markers_.push_back({marker, body.first_coordinate, body.num_coordinates()});
  }
}

void SystemForces::update(const SystemMotion& motion, std::span<const int> branches) {
  for (const int i : model_->acting_markers) wrenches_[static_cast<std::size_t>(i)] = Wrench{};
  power_ = {};
  Instant now{motion.time, motion.markers};
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    now.states = model_->states_of(f, motion.v.data());
    now.rate_slopes = rate_slopes_of(f);
    const Power power = force.add_wrenches(now, model_->branches_of(f, branches), wrenches_);
    power_.dissipated += power.dissipated;
    power_.input += power.input;
  }
  Q_.setZero();
  for (const ActingMarker& acting : acting_markers_) {
    const Wrench& wrench = wrenches_[acting.marker];
    if (!wrench.force.isZero(0.0) || wrench.torque != 0.0) add_wrench(acting, motion.markers[acting.marker]);
  }
  for (const ConstantBody& body : constant_bodies_) {
    Q_[body.first_coordinate] += body.mass * model_->gravity.x();
    Q_[body.first_coordinate + 1] += body.mass * model_->gravity.y();
  }
  for (VaryingBody& body : varying_bodies_) {
    const int first = body.first_coordinate;
    power_.dissipated +=
        body.forces.add(motion.masses[body.body], motion.rotations[body.body], model_->gravity,
                        motion.q.data() + first, motion.v.data() + first, Q_.data() + first);
  }
  if (!model_->states.empty()) set_state_rates(motion, branches);
  if (!fading_.empty()) add_fading_forces(motion);
}

// The generalized forces of internal states (system, eq. 14).
void SystemForces::set_state_rates(const SystemMotion& motion, std::span<const int> branches) {
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const std::span<double> rates = model_->states_of(f, Q_.data());
    if (rates.empty()) continue;
    const Instant now{motion.time, motion.markers, model_->states_of(f, motion.v.data())};
    model_->forces[f]->calc_state_rates(now, model_->branches_of(f, branches), rates);
  }
}

void SystemForces::add_wrench(const ActingMarker& acting, const MarkerState& state) {
  const Wrench& wrench = wrenches_[acting.marker];
  double* Q = Q_.data() + acting.first_coordinate;
  const MarkerRow row{wrench.force.x(), wrench.force.y(), wrench.torque};
  Q[0] += row.x;
  Q[1] += row.y;
  Q[2] += row.by_theta(state);
  if (acting.num_coordinates == 3) return;
  const MarkerRow in_body = row.in_body(state.rotation);
  const double* shape = state.Phi.data();
  for (int k = 3; k < acting.num_coordinates; ++k, shape += 3) Q[k] += in_body.by_mode(shape);
}

void SystemForces::add_fading_forces(const SystemMotion& motion) {
  for (const FadingForce& fading : fading_) {
    const double value = fading.value(motion.time);
    Q_[fading.coordinate] += value;
    power_.input += value * motion.v[fading.coordinate];
  }
}

}  // namespace sprung::dynamics
