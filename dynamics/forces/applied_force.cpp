#include "dynamics/forces/applied_force.h"

#include <array>

namespace sprung::dynamics {

Wrench AppliedForce::calc_wrench(const Instant& instant) const {
  const MarkerState& marker = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  Wrench wrench;
  wrench.force = {parameters_.force_x.value(instant.time), parameters_.force_y.value(instant.time)};
  wrench.torque = parameters_.torque.value(instant.time);
  if (parameters_.axes == Axes::kFollowing)
    wrench.force = FrameRotation::from_angle(marker.angle) * wrench.force;
  return wrench;
}

Power AppliedForce::add_wrenches(const Instant& instant, std::span<const int> /*branches*/,
                                 std::span<Wrench> wrenches) const {
  const MarkerState& marker = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const Wrench wrench = calc_wrench(instant);
  Wrench& on_marker = wrenches[static_cast<std::size_t>(parameters_.marker)];
  on_marker.force += wrench.force;
  on_marker.torque += wrench.torque;
  return {.input = wrench.force.dot(marker.v) + wrench.torque * marker.omega};
}

std::vector<const TimeFunction*> AppliedForce::time_functions() const {
  return {&parameters_.force_x, &parameters_.force_y, &parameters_.torque};
}

std::vector<int> AppliedForce::turned_markers() const {
  const bool has_torque = !parameters_.torque.is_constant() || parameters_.torque.value(0.0) != 0.0;
  return has_torque ? markers() : std::vector<int>();
}

ElementDescription AppliedForce::describe() const {
  const std::string axes = parameters_.axes == Axes::kWorld ? "world" : "following";
  return {.points = {"point"},
          .parameters = {{"axes", axes},
                         {"force_x", parameters_.force_x, "N", "s"},
                         {"force_y", parameters_.force_y, "N", "s"},
                         {"torque", parameters_.torque, "N m", "s"}}};
}

std::span<const Channel> AppliedForce::channels() const {
  static constexpr std::array<Channel, 3> kChannels{{{"force_x", "N", ChannelRole::kGiven},
                                                     {"force_y", "N", ChannelRole::kGiven},
                                                     {"torque", "N m", ChannelRole::kGiven}}};
  return kChannels;
}

void AppliedForce::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                                 std::span<double> values) const {
  const Wrench wrench = calc_wrench(instant);
  values[0] = wrench.force.x();
  values[1] = wrench.force.y();
  values[2] = wrench.torque;
}

}  // namespace sprung::dynamics
