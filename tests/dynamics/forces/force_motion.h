#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "dynamics/forces/force_element.h"
#include "tests/dynamics/random_numbers.h"

namespace sprung::test {

/// Markers in uniform motion, two if not said otherwise, for force elements alone, with the states of one at
/// constant rates.
struct MarkerPair {
  std::vector<dynamics::MarkerState> markers = std::vector<dynamics::MarkerState>(2);
  std::vector<double> states = {}, state_rates = {};

  dynamics::Instant instant() const { return {0.0, markers, states}; }
  /// After a time, the velocities kept.
  MarkerPair after(double time) const {
    MarkerPair moved = *this;
    for (dynamics::MarkerState& marker : moved.markers) {
      marker.r += time * marker.v;
      marker.angle += time * marker.omega;
    }
    for (std::size_t i = 0; i < state_rates.size(); ++i) moved.states[i] += time * state_rates[i];
    return moved;
  }
};

/// Power that a force element gives to its markers [W].
inline double calc_power(const MarkerPair& pair, const std::vector<dynamics::Wrench>& wrenches) {
  double power = 0.0;
  for (std::size_t i = 0; i < pair.markers.size(); ++i) {
    power += wrenches[i].force.dot(pair.markers[i].v) + wrenches[i].torque * pair.markers[i].omega;
  }
  return power;
}

/// The imbalance of a force element's energy, relative to the power that passes through it: d stored/dt +
/// dissipated − input + power on its markers, with d/dt of the stored energy by differences of fourth order.
inline double calc_energy_leak(const dynamics::ForceElement& element, const MarkerPair& pair,
                               const std::vector<int>& branches) {
  std::vector<dynamics::Wrench> wrenches(pair.markers.size());
  MarkerPair moving = pair;
  moving.state_rates.resize(pair.states.size());
  element.calc_state_rates(pair.instant(), branches, moving.state_rates);
  const dynamics::Power power = element.add_wrenches(pair.instant(), branches, wrenches);
  const double given = calc_power(pair, wrenches);
  constexpr double kStep = 2e-5;  // s
  const auto stored = [&](double steps) {
    return element.calc_stored_energy(moving.after(steps * kStep).instant(), branches);
  };
  const double stored_rate =
      (8.0 * (stored(1.0) - stored(-1.0)) - (stored(2.0) - stored(-2.0))) / (12.0 * kStep);
  const double passing =
      std::abs(stored_rate) + std::abs(power.dissipated) + std::abs(power.input) + std::abs(given);
  return passing > 0.0 ? (stored_rate + power.dissipated - power.input + given) / passing : 0.0;
}

}  // namespace sprung::test
