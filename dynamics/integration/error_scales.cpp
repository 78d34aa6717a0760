#include "dynamics/integration/error_scales.h"

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

// The share of the tolerance that is allowed in one step: errors of steps add up, and the tolerance is that
// of a whole run. With this share the energy book closes to the tolerance.
constexpr double kStepShare = 1.0 / 300.0;

}  // namespace

// A natural velocity: what gravity gives over a length scale, at least one natural size per second.
ErrorScales::ErrorScales(const Model& model)
    : velocity_scale_(std::max(1.0, std::sqrt(model.gravity.norm() / model.length_scale))) {
  for (int i = 0; i < model.num_coordinates; ++i) natural_.push_back(model.coordinate_scale(i));
  double mass = 0.0;
  for (const Body& body : model.bodies) mass += body.mass;
  energy_scale_ = 0.5 * mass * std::pow(velocity_scale_ * model.length_scale, 2);
}

double ErrorScales::position(int coordinate) const {
  return kStepShare * natural_[static_cast<std::size_t>(coordinate)];
}

double ErrorScales::velocity(int coordinate, double velocity) const {
  return kStepShare * (velocity_scale_ * natural_[static_cast<std::size_t>(coordinate)] + std::abs(velocity));
}

double ErrorScales::energy() const {
  return kStepShare * energy_scale_;
}

}  // namespace sprung::dynamics
