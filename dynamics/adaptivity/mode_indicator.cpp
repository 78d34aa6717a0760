#include "dynamics/adaptivity/mode_indicator.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kSameStep = 1e-9;  // relative: times of equal steps differ by rounding

}  // namespace

ModeIndicator::ModeIndicator(const Model& full, double time, const Eigen::VectorXd& q,
                             const std::vector<int>& points, const LinearisedSystem* linearised)
    : motion_(full, time, q, points, linearised),
      active_(motion_.modal_coordinates().size(), false),
      effective_(motion_, active_),
      sizes_(full, points),
      unbalanced_(full),
      state_{.time = time, .oscillators = std::vector<Oscillator>(active_.size())},
      accelerations_(active_.size()),
      amplitudes_(active_.size()) {
  update_left_out();
}

void ModeIndicator::update_left_out() {
  left_out_ = {};
  for (std::size_t j = 0; j < active_.size(); ++j) {
    if (active_[j]) continue;
    left_out_.modes.push_back(j);
    left_out_.stiffness.push_back(effective_[j].stiffness / effective_[j].mass);
    left_out_.decay.push_back(0.5 * effective_[j].damping / effective_[j].mass);
  }
  left_out_.responses.resize(left_out_.modes.size());
}

void ModeIndicator::set_active(const std::vector<bool>& is_active_coordinate) {
  for (std::size_t j = 0; j < active_.size(); ++j) {
    const bool now = is_active_coordinate[static_cast<std::size_t>(modal_coordinates()[j])];
    if (now != active_[j]) state_.oscillators[j] = {.is_fresh = state_.has_begun};
    active_[j] = now;
    accelerations_[j] = 0.0;
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

Eigen::Vector2d ModeIndicator::calc_missing_acceleration(std::size_t point) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t j = 0; j < accelerations_.size(); ++j)
    sum += accelerations_[j] * effective_[j].motion[point];
  return sum;
}

void ModeIndicator::update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot) {
  unbalanced_.update(run.terms(), run.multipliers(), q, v, v_dot);
  sizes_.update(q, v, v_dot);
  const double step = state_.has_begun ? time - state_.time : 0.0;
  if (step > 0.0 && std::abs(step - left_out_.step) > kSameStep * step) {
    calc_oscillator_responses(left_out_.stiffness, left_out_.decay, step, 1, left_out_.responses);
    left_out_.step = step;
  }
  for (std::size_t place = 0; place < left_out_.modes.size(); ++place) follow(place, step);
  state_.time = time;
  state_.has_begun = true;
}

// Follows one mode left out over a step in which the force changed linearly to its present value.
void ModeIndicator::follow(std::size_t place, double step) {
  const std::size_t mode = left_out_.modes[place];
  const double mass = effective_[mode].mass, decay = left_out_.decay[place],
               stiffness = left_out_.stiffness[place];
  Oscillator& one = state_.oscillators[mode];
  const double before = one.force / mass;
  one.force = unbalanced_.force()[modal_coordinates()[mode]];
  if (step > 0.0 || one.is_fresh) one.held_force = one.force;
  one.is_fresh = false;
  const double force = one.force / mass;
  if (step > 0.0) {
    const OscillatorResponse& r = left_out_.responses[place];
    const double slope = (force - before) / step, x = one.place, rate = one.rate;
    one.place = r.c * x + r.s * rate + r.forced[0] * before + r.forced[1] * slope;
    one.rate = r.c_rate * x + r.s_rate * rate + r.forced_rate(0) * before + r.forced_rate(1) * slope;
  }
  if (!state_.has_begun && stiffness > 0.0)
    one.place = force / stiffness;  // in balance at the start: no vibration
  // The amplitude, as the instantaneous value may pass through zero; at least the static deflection.
  const double amplitude = stiffness > 0.0
                               ? std::max(std::sqrt(one.place * one.place + one.rate * one.rate / stiffness),
                                          std::abs(force) / stiffness)
                               : std::abs(one.place);
  accelerations_[mode] = force - 2.0 * decay * one.rate - stiffness * one.place;
  const double acceleration =
      std::sqrt(accelerations_[mode] * accelerations_[mode] + stiffness * one.rate * one.rate);
  amplitudes_[mode] = {amplitude, acceleration};
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
