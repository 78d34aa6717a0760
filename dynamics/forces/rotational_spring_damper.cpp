#include "dynamics/forces/rotational_spring_damper.h"

#include <array>

namespace sprung::dynamics {

namespace {

// How far a piece of the characteristic is used beyond its end: far below what a torque could show.
constexpr double kDeflectionDeadBand = 1e-9;  // rad
constexpr double kRateDeadBand = 1e-6;        // rad/s

}  // namespace

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
  branches[0] = parameters_.spring.choose_piece(branches[0], twist.deflection, kDeflectionDeadBand);
  branches[1] = parameters_.damper.choose_piece(branches[1], twist.rate, kRateDeadBand);
}

void RotationalSpringDamper::calc_switches(const Instant& instant, std::span<const int> branches,
                                           std::span<double> values) const {
  const Twist twist = calc_twist(instant);
  parameters_.spring.calc_piece_switches(branches[0], twist.deflection, kDeflectionDeadBand, values);
  parameters_.damper.calc_piece_switches(
      branches[1], twist.rate, kRateDeadBand,
      values.subspan(static_cast<std::size_t>(parameters_.spring.num_switches())));
}

// What a spring takes up it stores, so that its power does not count.
Passage RotationalSpringDamper::passage(int switch_index, std::span<const int> branches) const {
  const int of_damper = switch_index - parameters_.spring.num_switches();
  if (of_damper < 0 || parameters_.damper.ends_at_zero(branches[1], of_damper)) return Passage::kBendAtRest;
  return Passage::kBend;
}

void RotationalSpringDamper::go_beyond(int switch_index, std::span<int> branches) const {
  const int of_damper = switch_index - parameters_.spring.num_switches();
  if (of_damper < 0)
    branches[0] += switch_index == 0 ? -1 : 1;
  else
    branches[1] += of_damper == 0 ? -1 : 1;
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
