#include "dynamics/forces/spring_damper.h"

#include <array>

#include "dynamics/forces/marker_line.h"

namespace sprung::dynamics {

struct SpringDamper::Line : MarkerLine {
  double deflection;
};

SpringDamper::Line SpringDamper::calc_line(const Instant& instant) const {
  const MarkerLine line = calc_marker_line(instant.markers[static_cast<std::size_t>(parameters_.marker_a)],
                                           instant.markers[static_cast<std::size_t>(parameters_.marker_b)]);
  return {line, parameters_.free_length - line.length};
}

Power SpringDamper::add_wrenches(const Instant& instant, std::span<const int> branches,
                                 std::span<Wrench> wrenches) const {
  const Line line = calc_line(instant);
  const double spring_force =
      parameters_.multiplicity * parameters_.spring.value_in_piece(branches[0], line.deflection);
  const double damper_force = calc_damper_force(instant, branches[1], line.rate);
  const Eigen::Vector2d on_b = (spring_force + damper_force) * line.direction;
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].force += on_b;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].force -= on_b;
  return {.dissipated = damper_force * line.rate};
}

double SpringDamper::calc_stored_energy(const Instant& instant, std::span<const int> /*branches*/) const {
  return parameters_.multiplicity * parameters_.spring.integral(calc_line(instant).deflection);
}

SpringDamper::Deflection SpringDamper::calc_deflection(const Instant& instant) const {
  const Line line = calc_line(instant);
  return {line.deflection, line.rate};
}

ElementDescription SpringDamper::describe() const {
  ElementDescription description{.points = {"a", "b"},
                                 .parameters = {{"free_length", parameters_.free_length, "m"}},
                                 .drawing = Drawing::kSpring};
  describe_laws({.deflection = "m", .rate = "m/s", .force = "N"}, parameters_, description);
  return description;
}

std::span<const Channel> SpringDamper::channels() const {
  static constexpr std::array<Channel, 4> kChannels{{{"length", "m", ChannelRole::kExtent},
                                                     {"deflection", "m", ChannelRole::kDeflection},
                                                     {"rate", "m/s", ChannelRole::kRate},
                                                     {"force", "N", ChannelRole::kForce}}};
  return kChannels;
}

void SpringDamper::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                                 std::span<double> values) const {
  const Line line = calc_line(instant);
  values[0] = line.length;
  values[1] = line.deflection;
  values[2] = line.rate;
  values[3] = parameters_.multiplicity * parameters_.spring.value(line.deflection) +
              calc_damper_force(instant, line.rate);
}

}  // namespace sprung::dynamics
