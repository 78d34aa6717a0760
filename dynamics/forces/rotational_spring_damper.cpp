#include "dynamics/forces/rotational_spring_damper.h"

#include <array>

namespace sprung::dynamics {

RotationalSpringDamper::Deflection RotationalSpringDamper::calc_deflection(const Instant& instant) const {
  const MarkerState& a = instant.markers[static_cast<std::size_t>(parameters_.marker_a)];
  const MarkerState& b = instant.markers[static_cast<std::size_t>(parameters_.marker_b)];
  return {.value = parameters_.free_angle - (b.angle - a.angle), .rate = -(b.omega - a.omega)};
}

Power RotationalSpringDamper::add_wrenches(const Instant& instant, std::span<const int> branches,
                                           std::span<Wrench> wrenches) const {
  const Deflection d = calc_deflection(instant);
  const double spring_torque =
      parameters_.multiplicity * parameters_.spring.value_in_piece(branches[0], d.value);
  const double damper_torque = calc_damper_force(instant, branches[1], d.rate);
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].torque += spring_torque + damper_torque;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].torque -= spring_torque + damper_torque;
  return {.dissipated = damper_torque * d.rate};
}

double RotationalSpringDamper::calc_stored_energy(const Instant& instant,
                                                  std::span<const int> /*branches*/) const {
  return parameters_.multiplicity * parameters_.spring.integral(calc_deflection(instant).value);
}

ElementDescription RotationalSpringDamper::describe() const {
  ElementDescription description{.points = {"a", "b"},
                                 .parameters = {{"free_angle", parameters_.free_angle, "rad"}}};
  describe_laws({.deflection = "rad", .rate = "rad/s", .force = "N m"}, parameters_, description);
  return description;
}

std::span<const Channel> RotationalSpringDamper::channels() const {
  static constexpr std::array<Channel, 4> kChannels{{{"angle", "rad", ChannelRole::kExtent},
                                                     {"deflection", "rad", ChannelRole::kDeflection},
                                                     {"rate", "rad/s", ChannelRole::kRate},
                                                     {"torque", "N m", ChannelRole::kTorque}}};
  return kChannels;
}

void RotationalSpringDamper::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                                           std::span<double> values) const {
  const Deflection d = calc_deflection(instant);
  values[0] = parameters_.free_angle - d.value;
  values[1] = d.value;
  values[2] = d.rate;
  values[3] =
      parameters_.multiplicity * parameters_.spring.value(d.value) + calc_damper_force(instant, d.rate);
}

}  // namespace sprung::dynamics
