#include "dynamics/adaptivity/mode_indicator.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

ModeIndicator::ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q,
                             const std::vector<int>& points, const LinearisedSystem* linearised)
    : motion_(full, time, q, points, linearised),
      active_(motion_.modal_coordinates().size(), false),
      effective_(motion_, active_),
      sizes_(full, points),
      unbalanced_(full),
      state_{.time = time, .oscillators = std::vector<Oscillator>(active_.size())},
      amplitudes_(active_.size()) {
  update_left_out();
}

void ModeIndicator::update_left_out() {
  left_out_.clear();
  responses_.clear();
  for (std::size_t j = 0; j < active_.size(); ++j) {
    if (active_[j]) continue;
    left_out_.push_back(j);
    responses_.add(effective_[j].stiffness / effective_[j].mass,
                   0.5 * effective_[j].damping / effective_[j].mass);
  }
}

std::size_t ModeIndicator::mode_of(int coordinate) const {
  const std::vector<int>& modal = modal_coordinates();
  return static_cast<std::size_t>(std::lower_bound(modal.begin(), modal.end(), coordinate) - modal.begin());
}

void ModeIndicator::set_active(const std::vector<bool>& is_active_coordinate) {
  for (std::size_t j = 0; j < active_.size(); ++j) {
    const bool now = is_active_coordinate[static_cast<std::size_t>(modal_coordinates()[j])];
    if (now != active_[j]) state_.oscillators[j] = {.is_fresh = state_.has_begun};
    active_[j] = now;
    amplitudes_[j] = {};
  }
  const EffectiveModes before = effective_;
  effective_.update(active_);
  update_left_out();
  for (std::size_t j = 0; j < active_.size(); ++j) {
    Oscillator& one = state_.oscillators[j];
    if (before[j].stiffness > 0.0 && effective_[j].stiffness > 0.0) {
      one.place += one.force / effective_[j].stiffness - one.force / before[j].stiffness;
    }
  }
}

void ModeIndicator::continue_run() {
  for (Oscillator& one : state_.oscillators) one.is_fresh = true;
}

ModeShare ModeIndicator::calc_share(std::size_t mode, const ModeAmplitude& amplitude) const {
  return sizes_.calc_share(calc_deflection(mode, amplitude),
                           [&](std::size_t point) { return calc_acceleration(mode, point, amplitude); });
}

void ModeIndicator::update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  unbalanced_.update(run.terms(), run.multipliers(), q, v, v_dot);
  sizes_.update(q, v, v_dot);
  const double step = state_.has_begun ? time - state_.time : 0.0;
  if (step > 0.0) responses_.prepare(step);
  for (std::size_t place = 0; place < left_out_.size(); ++place) follow(place, step);
  state_.time = time;
  state_.has_begun = true;
}

// Follows one mode left out over a step in which the force changed linearly to its present value.
void ModeIndicator::follow(std::size_t place, double step) {
  const std::size_t mode = left_out_[place];
  const double mass = effective_[mode].mass, decay = responses_.decay(place),
               stiffness = responses_.stiffness(place);
  Oscillator& one = state_.oscillators[mode];
  const double before = one.force / mass;
  one.force = unbalanced_.force()[modal_coordinates()[mode]];
  if (step > 0.0 || one.is_fresh) one.held_force = one.force;
  one.is_fresh = false;
  const double force = one.force / mass;
  if (step > 0.0) responses_.advance(place, before, force, one.place, one.rate);
  if (!state_.has_begun && stiffness > 0.0 && is_balanced_)
    one.place = force / stiffness;  // in balance at the start: no vibration
  // The amplitude, as the instantaneous value may pass through zero; at least the static deflection.
  const double amplitude = stiffness > 0.0
                               ? std::max(std::sqrt(one.place * one.place + one.rate * one.rate / stiffness),
                                          std::abs(force) / stiffness)
                               : std::abs(one.place);
  const double acceleration = force - 2.0 * decay * one.rate - stiffness * one.place;
  amplitudes_[mode] = {amplitude, std::sqrt(acceleration * acceleration + stiffness * one.rate * one.rate)};
}

template <class Bytes, class Indicator>
void ModeIndicator::transfer(Bytes& bytes, Indicator& indicator) {
  bytes.transfer(indicator.state_.time);
  bytes.transfer(indicator.state_.has_begun);
  bytes.transfer_items(indicator.state_.oscillators, [&](auto& one) {
    bytes.transfer(one.place);
    bytes.transfer(one.rate);
    bytes.transfer(one.force);
    bytes.transfer(one.held_force);
    bytes.transfer(one.is_fresh);
  });
}

void ModeIndicator::save(support::ByteWriter& bytes) const {
  transfer(bytes, *this);
  sizes_.save(bytes);
}

void ModeIndicator::restore(support::ByteReader& bytes) {
  transfer(bytes, *this);
  if (state_.oscillators.size() != num_modes()) throw support::DamagedBytes();
  sizes_.restore(bytes);
}

}  // namespace sprung::dynamics
