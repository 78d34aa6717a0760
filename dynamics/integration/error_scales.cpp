#include "dynamics/integration/error_scales.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

// The share of the tolerance that is allowed in one step: errors of steps add up, and the tolerance is that
// of a whole run. With this share the energy book closes to the tolerance.
constexpr double kStepShare = 1.0 / 300.0;
// Likewise for accelerations of vibration whose every period takes several steps: their errors may have one
// sign.
constexpr double kVibrationShare = 1.0 / 4.0;

}  // namespace

// A natural velocity: what gravity gives over a length scale, at least one natural size per second.
ErrorScales::ErrorScales(const Model& model)
    : velocity_scale_(std::max(1.0, std::sqrt(model.gravity.norm() / model.length_scale))) {
  for (int i = 0; i < model.num_coordinates; ++i) natural_.push_back(model.coordinate_scale(i));
  frequency_.assign(natural_.size(), 0.0);
  double mass = 0.0;
  for (const Body& body : model.bodies) {
    mass += body.mass;
    for (int k = 0; k < body.num_modes(); ++k) {
      frequency_[static_cast<std::size_t>(body.first_coordinate + 3 + k)] =
          std::sqrt(body.stiffness(k, k) / body.modal_mass[k]);
    }
  }
  energy_scale_ = 0.5 * mass * std::pow(velocity_scale_ * model.length_scale, 2);
}

double ErrorScales::position(int coordinate) const {
  return kStepShare * natural_[static_cast<std::size_t>(coordinate)];
}

double ErrorScales::velocity(int coordinate, double velocity) const {
  return kStepShare * (velocity_scale_ * natural_[static_cast<std::size_t>(coordinate)] + std::abs(velocity));
}

double ErrorScales::position_in_vibration(int coordinate) const {
  const double frequency = frequency_[static_cast<std::size_t>(coordinate)];
  if (frequency == 0.0) return position(coordinate);
  return std::min(position(coordinate), velocity_in_vibration(coordinate, 0.0) / frequency);
}

// Natural acceleration: the natural velocity times velocity_scale_.
double ErrorScales::velocity_in_vibration(int coordinate, double velocity) const {
  const auto i = static_cast<std::size_t>(coordinate);
  const double ratio = frequency_[i] / (kVibrationShare * velocity_scale_);
  return kStepShare * (velocity_scale_ * natural_[i] / (1.0 + ratio) + std::abs(velocity));
}

double ErrorScales::energy() const {
  return kStepShare * energy_scale_;
}

}  // namespace sprung::dynamics
