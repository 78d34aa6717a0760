#include "dynamics/forces/leaf_spring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "dynamics/forces/friction_loop.h"
#include "dynamics/forces/marker_line.h"

namespace sprung::dynamics {

namespace {

// How far a branch is used beyond its end, as for springs and dampers.
constexpr double kLeafDeadBand = 1e-9;      // m
constexpr double kLeafRateDeadBand = 1e-6;  // m/s

// R.m.s. values that the linearisation for random motion begins with, and the least that it takes.
constexpr double kLeafDeflection = 0.01;                                // m
constexpr double kLeafRate = kLeafDeflection * 4.0 * std::numbers::pi;  // m/s, at 2 Hz
constexpr double kLeastLeafRms = 1e-9;                                  // m, m/s

// The largest full friction at a point of its law.
double find_largest(const PiecewisePolynomial& friction) {
  double largest = friction.value(0.0);
  for (const double at : friction.breaks()) largest = std::max(largest, friction.value(at));
  return largest;
}

}  // namespace

struct LeafSpring::Line : MarkerLine {
  double deflection;
  double share;  // friction, of its full value: p
};

LeafSpring::LeafSpring(std::string element_name, Parameters parameters)
    : ForceElement(std::move(element_name)),
      parameters_(std::move(parameters)),
      full_state_(std::sqrt(parameters_.multiplicity * find_largest(parameters_.friction) *
                            parameters_.presliding_deflection)) {}

LeafSpring::Line LeafSpring::calc_line(const Instant& instant) const {
  const MarkerLine line = calc_marker_line(instant.markers[static_cast<std::size_t>(parameters_.marker_a)],
                                           instant.markers[static_cast<std::size_t>(parameters_.marker_b)]);
  return {line, parameters_.free_length - line.length, instant.states[0] / full_state_};
}

// d/dt of the energy stored by friction, ½ β N F_c p², is its power less what is dissipated.
Power LeafSpring::add_wrenches(const Instant& instant, std::span<const int> branches,
                               std::span<Wrench> wrenches) const {
  const Line line = calc_line(instant);
  const double full =
      parameters_.multiplicity * parameters_.friction.value_in_piece(branches[1], line.deflection);
  const double slope =
      parameters_.multiplicity * parameters_.friction.slope_in_piece(branches[1], line.deflection);
  const double elastic =
      parameters_.multiplicity * parameters_.spring.value_in_piece(branches[0], line.deflection);
  const Eigen::Vector2d on_b = (elastic + full * line.share) * line.direction;
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].force += on_b;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].force -= on_b;
  const double speed = branches[2] == kCompressing ? line.rate : -line.rate;
  const double square = line.share * line.share;
  return {.dissipated =
              full * speed * square - 0.5 * parameters_.presliding_deflection * slope * line.rate * square};
}

double LeafSpring::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  const Line line = calc_line(instant);
  const double full = parameters_.friction.value_in_piece(branches[1], line.deflection);
  return parameters_.multiplicity *
         (parameters_.spring.integral(line.deflection) +
          0.5 * parameters_.presliding_deflection * full * line.share * line.share);
}

std::vector<InternalState> LeafSpring::internal_states() const {
  return {
      {.name = "friction", .size = full_state_ / parameters_.presliding_deflection, .is_per_length = true}};
}

void LeafSpring::calc_state_rates(const Instant& instant, std::span<const int> branches,
                                  std::span<double> rates) const {
  const Line line = calc_line(instant);
  const double speed = branches[2] == kCompressing ? line.rate : -line.rate;
  rates[0] = (full_state_ * line.rate - speed * instant.states[0]) / parameters_.presliding_deflection;
}

RandomLaws LeafSpring::linearise_for_random_motion(const Instant& /*at_rest*/,
                                                   std::span<const int> /*branches*/,
                                                   std::span<const double> rms) const {
  const double deflection = rms.empty() ? kLeafDeflection : std::max(rms[1], kLeastLeafRms);
  const double rate = rms.empty() ? kLeafRate : std::max(rms[2], kLeastLeafRms);
  const LinearFriction law = linearise_friction(deflection, rate, parameters_.presliding_deflection);
  return {.states = StateLinearisation{.gain = Eigen::VectorXd::Constant(1, law.gain),
                                       .decay = Eigen::MatrixXd::Constant(1, 1, law.decay)}};
}

void LeafSpring::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Line line = calc_line(instant);
  branches[0] = parameters_.spring.choose_piece(branches[0], line.deflection, kLeafDeadBand);
  branches[1] = parameters_.friction.choose_piece(branches[1], line.deflection, kLeafDeadBand);
  const double least = (branches[2] == kCompressing ? -0.5 : 0.5) * kLeafRateDeadBand;
  branches[2] = line.rate > least ? kCompressing : kExtending;
}

void LeafSpring::calc_switches(const Instant& instant, std::span<const int> branches,
                               std::span<double> values) const {
  const Line line = calc_line(instant);
  values[0] = kLeafRateDeadBand + (branches[2] == kCompressing ? line.rate : -line.rate);
  const auto pieces = values.subspan(1);
  parameters_.spring.calc_piece_switches(branches[0], line.deflection, kLeafDeadBand, pieces);
  parameters_.friction.calc_piece_switches(
      branches[1], line.deflection, kLeafDeadBand,
      pieces.subspan(static_cast<std::size_t>(parameters_.spring.num_switches())));
}

ElementDescription LeafSpring::describe() const {
  return {.points = {"a", "b"},
          .parameters = {{"free_length", parameters_.free_length, "m"},
                         {"multiplicity", parameters_.multiplicity, "1"},
                         {"spring", parameters_.spring, "N", "m"},
                         {"friction", parameters_.friction, "N", "m"},
                         {"presliding_deflection", parameters_.presliding_deflection, "m"}},
          .drawing = Drawing::kSpring};
}

std::span<const Channel> LeafSpring::channels() const {
  static constexpr std::array<Channel, 5> kChannels{{{"length", "m", ChannelRole::kExtent},
                                                     {"deflection", "m", ChannelRole::kDeflection},
                                                     {"rate", "m/s", ChannelRole::kRate},
                                                     {"force", "N", ChannelRole::kForce},
                                                     {"friction", "N", ChannelRole::kForce}}};
  return kChannels;
}

void LeafSpring::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                               std::span<double> values) const {
  const Line line = calc_line(instant);
  values[0] = line.length;
  values[1] = line.deflection;
  values[2] = line.rate;
  values[4] = parameters_.multiplicity * parameters_.friction.value(line.deflection) * line.share;
  values[3] = parameters_.multiplicity * parameters_.spring.value(line.deflection) + values[4];
}

}  // namespace sprung::dynamics
