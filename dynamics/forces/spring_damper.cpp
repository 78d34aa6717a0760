#include "dynamics/forces/spring_damper.h"

#include <array>

namespace sprung::dynamics {

namespace {

// How far a piece of the characteristic is used beyond its end: far below what a force could show.
constexpr double kDeflectionDeadBand = 1e-9;  // m
constexpr double kRateDeadBand = 1e-6;        // m/s

}  // namespace

struct SpringDamper::Line {
  Eigen::Vector2d direction;  // from a to b
  double length;
  double deflection;
  double rate;  // ḋ
};

SpringDamper::Line SpringDamper::calc_line(const Instant& instant) const {
  const MarkerState& a = instant.markers[static_cast<std::size_t>(parameters_.marker_a)];
  const MarkerState& b = instant.markers[static_cast<std::size_t>(parameters_.marker_b)];
  const Eigen::Vector2d span = b.r - a.r;
  Line line;
  line.length = span.norm();
  // Markers in one place leave no direction; the force then has none either, and the spring goes through its middle.
  line.direction = line.length > 0.0 ? Eigen::Vector2d(span / line.length) : Eigen::Vector2d::Zero();
  line.deflection = parameters_.free_length - line.length;
  line.rate = -line.direction.dot(b.v - a.v);
  return line;
}

Power SpringDamper::add_wrenches(const Instant& instant, std::span<const int> branches,
                                 std::span<Wrench> wrenches) const {
  const Line line = calc_line(instant);
  const double spring_force =
      parameters_.multiplicity * parameters_.spring.value_in_piece(branches[0], line.deflection);
  const double damper_force = parameters_.multiplicity * parameters_.damper.value_in_piece(branches[1], line.rate);
  const Eigen::Vector2d on_b = (spring_force + damper_force) * line.direction;
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].force += on_b;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].force -= on_b;
  return {.dissipated = damper_force * line.rate};
}

double SpringDamper::calc_stored_energy(const Instant& instant, std::span<const int> /*branches*/) const {
  return parameters_.multiplicity * parameters_.spring.integral(calc_line(instant).deflection);
}

void SpringDamper::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Line line = calc_line(instant);
  branches[0] = parameters_.spring.choose_piece(branches[0], line.deflection, kDeflectionDeadBand);
  branches[1] = parameters_.damper.choose_piece(branches[1], line.rate, kRateDeadBand);
}

void SpringDamper::calc_switches(const Instant& instant, std::span<const int> branches,
                                 std::span<double> values) const {
  const Line line = calc_line(instant);
  parameters_.spring.calc_piece_switches(branches[0], line.deflection, kDeflectionDeadBand, values);
  parameters_.damper.calc_piece_switches(
      branches[1], line.rate, kRateDeadBand,
      values.subspan(static_cast<std::size_t>(parameters_.spring.num_switches())));
}

// What a spring takes up it stores, so that its power does not count.
Passage SpringDamper::passage(int switch_index, std::span<const int> branches) const {
  const int of_damper = switch_index - parameters_.spring.num_switches();
  if (of_damper < 0 || parameters_.damper.ends_at_zero(branches[1], of_damper)) return Passage::kBendAtRest;
  return Passage::kBend;
}

void SpringDamper::go_beyond(int switch_index, std::span<int> branches) const {
  const int of_damper = switch_index - parameters_.spring.num_switches();
  if (of_damper < 0)
    branches[0] += switch_index == 0 ? -1 : 1;
  else
    branches[1] += of_damper == 0 ? -1 : 1;
}

std::span<const Channel> SpringDamper::channels() const {
  static constexpr std::array<Channel, 4> kChannels{
      {{"length", "m"}, {"deflection", "m"}, {"rate", "m/s"}, {"force", "N"}}};
  return kChannels;
}

void SpringDamper::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                                 std::span<double> values) const {
  const Line line = calc_line(instant);
  values[0] = line.length;
  values[1] = line.deflection;
  values[2] = line.rate;
  values[3] = parameters_.multiplicity *
              (parameters_.spring.value(line.deflection) + parameters_.damper.value(line.rate));
}

}  // namespace sprung::dynamics
