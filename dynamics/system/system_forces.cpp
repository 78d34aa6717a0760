// What SystemTerms does about forces, and the energy that goes with them.
#include "dynamics/system/system_terms.h"

namespace sprung::dynamics {

void SystemTerms::add_wrench(const MovingMarker& moving, const Wrench& wrench,
                             Eigen::VectorXd& forces) const {
  const MarkerState& state = markers_[moving.marker];
  double* Q = forces.data() + moving.first_coordinate;
  const MarkerRow row{wrench.force.x(), wrench.force.y(), wrench.torque};
  Q[0] += row.x;
  Q[1] += row.y;
  Q[2] += row.by_theta(state);
  if (moving.is_rigid()) return;
  const MarkerRow in_body = row.in_body(state.rotation);
  const double* shape = state.Phi.data();
  for (int k = 3; k < moving.num_coordinates; ++k, shape += 3) Q[k] += in_body.by_mode(shape);
}

void SystemTerms::update_forces(std::span<const int> branches) {
  assert(has(Term::kPositions) && has(Term::kVelocities));
  for (const int i : model_->acting_markers) wrenches_[static_cast<std::size_t>(i)] = Wrench{};
  power_ = {};
  const Instant now = instant();
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    const Power power = force.add_wrenches(now, model_->branches_of(f, branches), wrenches_);
    power_.dissipated += power.dissipated;
    power_.input += power.input;
  }
  Q_.setZero();
  for (const MovingMarker& moving : acting_markers_) {
    const Wrench& wrench = wrenches_[moving.marker];
    if (!wrench.force.isZero(0.0) || wrench.torque != 0.0) add_wrench(moving, wrench, Q_);
  }
  for (const ConstantBody& body : constant_bodies_) {
    Q_[body.first_coordinate] += body.mass * model_->gravity.x();
    Q_[body.first_coordinate + 1] += body.mass * model_->gravity.y();
  }
  for (const std::size_t b : varying_bodies_) add_body_forces(b);
  set(Term::kForces);
}

// Weight, quadratic velocity terms, stiffness, damping.
void SystemTerms::add_body_forces(std::size_t b) {
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

void SystemTerms::calc_loads(const Eigen::VectorXd& lambda, std::span<Wrench> loads) const {
  assert(has(Term::kJacobian) && has(Term::kForces));
  std::copy(wrenches_.begin(), wrenches_.end(), loads.begin());
  for (const JointTerms& terms : joints_) {
    for (const JointSide* side : {&terms.a, &terms.b}) {
      Wrench& load = loads[side->marker];
      for (int k = 0; k < terms.num_rows; ++k) {
        const double multiplier = lambda[terms.row + k];
        load.force -= multiplier * side->G.row(k).head<2>().transpose();
        load.torque -= multiplier * side->G(k, 2);
      }
    }
  }
}

void SystemTerms::choose_branches(std::span<int> branches) const {
  const Instant now = instant();
  for (std::size_t f = 0; f < model_->forces.size(); ++f) {
    const ForceElement& force = *model_->forces[f];
    force.choose_branches(now, model_->branches_of(f, branches));
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
    energy.spring += force.calc_stored_energy(terms.instant(), model.branches_of(f, branches));
  }
  return energy;
}

}  // namespace sprung::dynamics
