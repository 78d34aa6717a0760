#include "dynamics/adaptivity/full_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "dynamics/system/energy.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

FullMotion::FullMotion(const Model& full, const State& start)
    : full_(&full),
      terms_(full),
      q_(start.q),
      v_(start.v),
      v_dot_(Eigen::VectorXd::Zero(full.num_coordinates)) {}

void FullMotion::take(const HeldModes& held, const ConstrainedEquations& equations) {
  v_.setZero();
  v_dot_.setZero();
  put_active(held, equations.q(), q_);
  put_active(held, equations.v(), v_);
  put_active(held, equations.v_dot(), v_dot_);
}

void FullMotion::go_to(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  q_ = q;
  v_ = v;
}

void FullMotion::update_terms(double time) {
  terms_.update_positions(time, q_);
  terms_.update_mass();
  terms_.update_velocities(v_);
}

double FullMotion::calc_held_strain(const std::vector<bool>& is_active) const {
  double strain = 0.0;
  for (const Body& body : full_->bodies) {
    Eigen::VectorXd eta = q_.segment(body.first_coordinate + 3, body.num_modes());
    for (Eigen::Index k = 0; k < eta.size(); ++k) {
      if (is_active[static_cast<std::size_t>(body.first_coordinate + 3 + k)]) eta[k] = 0.0;
    }
    strain += 0.5 * eta.dot(body.stiffness * eta);
  }
  return strain;
}

HeldModes FullMotion::hold(const std::vector<bool>& is_active) const {
  return hold_modes(*full_, is_active, q_);
}

State FullMotion::state_for(const HeldModes& held, double time, const std::vector<int>& branches) const {
  State state{.time = time, .q = select_active(held, q_), .v = select_active(held, v_), .branches = branches};
  for (FadingForce fading : fading_) {
    const auto place = std::lower_bound(held.coordinates.begin(), held.coordinates.end(), fading.coordinate);
    const bool is_held = place == held.coordinates.end() || *place != fading.coordinate;
    if (is_held || fading.has_ended(time)) continue;
    fading.coordinate = static_cast<int>(place - held.coordinates.begin());
    state.fading.push_back(fading);
  }
  return state;
}

void FullMotion::release(int coordinate, double force, double time, double duration) {
  std::erase_if(fading_, [&](const FadingForce& one) { return one.has_ended(time); });
  fading_.push_back({coordinate, force, time, duration});
}

// An impulse on the modes that leave, and on no other coordinate, stops them: M v of the others stays, except
// for the impulses of the joints.
double FullMotion::stop(const std::vector<int>& coordinates, const HeldModes& held, double time,
                        std::span<const int> branches) {
  update_terms(time);
  const double energy = calc_energy(terms_, branches).total();
  Eigen::VectorXd momentum = v_;  // of internal states
  for (std::size_t b = 0; b < full_->bodies.size(); ++b) {
    const Body& body = full_->bodies[b];
    momentum.segment(body.first_coordinate, body.num_coordinates()) =
        terms_.mass(b) * v_.segment(body.first_coordinate, body.num_coordinates());
  }
  for (const int coordinate : coordinates) v_[coordinate] = v_dot_[coordinate] = 0.0;

  ConstrainedEquations equations(held.model, SystemTerms::Markers::kActing);
  if (!equations.close_joints(time, select_active(held, q_))) {
    throw support::NumericalError(
        fmt::format("the joints cannot be closed at t = {:.9g} s, where modes leave", time));
  }
  Eigen::VectorXd v = select_active(held, momentum);
  equations.terms().update_mass();
  for (std::size_t b = 0; b < held.model.bodies.size(); ++b) {
    equations.terms().masses()[b].solve(v.data() + held.model.bodies[b].first_coordinate);
  }
  equations.close_rates(v);
  put_active(held, equations.q(), q_);
  put_active(held, equations.v(), v_);
  update_terms(time);
  return energy - calc_energy(terms_, branches).total();
}

void FullMotion::restore(support::ByteReader& bytes) {
  transfer(bytes, *this);
  const Eigen::Index size = full_->num_coordinates;
  if (q_.size() != size || v_.size() != size) throw support::DamagedBytes();
}

}  // namespace sprung::dynamics
