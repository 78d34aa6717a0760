#include "dynamics/forces/rotational_spring_damper.h"

#include <array>

namespace sprung::dynamics {

RotationalSpringDamper::Twist RotationalSpringDamper::calc_twist(const Instant& instant) const {
  const MarkerState& a = instant.markers[static_cast<std::size_t>(parameters_.marker_a)];
  const MarkerState& b = instant.markers[static_cast<std::size_t>(parameters_.marker_b)];
  return {.deflection = parameters_.free_angle - (b.angle - a.angle), .rate = -(b.omega - a.omega)};
}

Power RotationalSpringDamper::add_wrenches(const Instant& instant, std::span<const int> branches,
                                           std::span<Wrench> wrenches) const {
  const Twist twist = calc_twist(instant);
  const double spring_torque =
      parameters_.multiplicity * parameters_.spring.value_in_piece(branches[0], twist.deflection);
  const double damper_torque =
      parameters_.multiplicity * parameters_.damper.value_in_piece(branches[1], twist.rate);
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].torque += spring_torque + damper_torque;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].torque -= spring_torque + damper_torque;
  return {.dissipated = damper_torque * twist.rate};
}

double RotationalSpringDamper::calc_stored_energy(const Instant& instant,
                                                  std::span<const int> /*branches*/) const {
  return parameters_.multiplicity * parameters_.spring.integral(calc_twist(instant).deflection);
}

void RotationalSpringDamper::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Twist twist = calc_twist(instant);
  laws().choose_branches(twist.deflection, twist.rate, branches);
}

void RotationalSpringDamper::calc_switches(const Instant& instant, std::span<const int> branches,
                                           std::span<double> values) const {
  const Twist twist = calc_twist(instant);
  laws().calc_switches(twist.deflection, twist.rate, branches, values);
}

std::span<const Channel> RotationalSpringDamper::channels() const {
  static constexpr std::array<Channel, 4> kChannels{
      {{"angle", "rad"}, {"deflection", "rad"}, {"rate", "rad/s"}, {"torque", "N m"}}};
  return kChannels;
}

void RotationalSpringDamper::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                                           std::span<double> values) const {
  const Twist twist = calc_twist(instant);
  values[0] = parameters_.free_angle - twist.deflection;
  values[1] = twist.deflection;
  values[2] = twist.rate;
  values[3] = parameters_.multiplicity *
              (parameters_.spring.value(twist.deflection) + parameters_.damper.value(twist.rate));
}

}  // namespace sprung::dynamics
