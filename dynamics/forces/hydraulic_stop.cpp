#include "dynamics/forces/hydraulic_stop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamics/forces/marker_line.h"

namespace sprung::dynamics {

namespace {

// How far a branch is used beyond its end, as for springs and dampers.
constexpr double kOverlapDeadBand = 1e-9;      // m
constexpr double kOverlapRateDeadBand = 1e-6;  // m/s
constexpr double kForceDeadBandShare = 1e-6;   // of the force at this overlap and rate:
constexpr double kUsualOverlapShare = 0.01;    // of the contact length
constexpr double kUsualRate = 1.0;             // m/s
constexpr double kUsualRandomRate = 0.1;       // m/s, r.m.s., that the linearisation begins with

}  // namespace

struct HydraulicStop::Line : MarkerLine {
  double overlap;  // δ; its rate is that of the line
  std::span<const double> rate_slopes;
};

struct HydraulicStop::Law {
  double elastic;  // F_s in contact, else 0
  double sum;      // of all parts, as if it could pull
  double force;
};

HydraulicStop::HydraulicStop(std::string element_name, Parameters parameters)
    : ForceElement(std::move(element_name)), parameters_(std::move(parameters)) {
  const double overlap = kUsualOverlapShare * parameters_.contact_length;
  force_dead_band_ = kForceDeadBandShare * (std::abs(parameters_.spring.value(overlap)) +
                                            parameters_.damping * overlap * kUsualRate +
                                            parameters_.metering.value(overlap) * kUsualRate * kUsualRate);
}

HydraulicStop::Line HydraulicStop::calc_line(const Instant& instant) const {
  const MarkerLine line = calc_marker_line(instant.markers[static_cast<std::size_t>(parameters_.marker_a)],
                                           instant.markers[static_cast<std::size_t>(parameters_.marker_b)]);
  return {line, parameters_.contact_length - line.length, instant.rate_slopes};
}

HydraulicStop::Law HydraulicStop::calc_law(const Line& line, std::span<const int> branches) const {
  if (branches[0] == kApart) return {.elastic = 0.0, .sum = 0.0, .force = 0.0};
  Law law;
  law.elastic = parameters_.spring.value_in_piece(branches[1], line.overlap);
  law.sum = law.elastic + parameters_.damping * line.overlap * line.rate;
  if (!line.rate_slopes.empty())
    law.sum = law.elastic + line.rate_slopes[0] * line.rate;
  else if (branches[3] == kThroughOrifice)
    law.sum += parameters_.metering.value_in_piece(branches[2], line.overlap) * line.rate * line.rate;
  law.force = branches[0] == kPushing ? law.sum : 0.0;
  return law;
}

// E[c_h v³; v > 0]/σ² = √(2/π) c_h σ for a normal v.
RandomLaws HydraulicStop::linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                                      std::span<const double> rms) const {
  if (branches[0] == kApart || parameters_.metering.is_zero()) return {};
  const Line line = calc_line(at_rest);
  const double rate = rms.empty() ? kUsualRandomRate : rms[2];
  const double resistance = parameters_.metering.value_in_piece(branches[2], line.overlap);
  return {.rate_slopes = {parameters_.damping * line.overlap +
                          std::sqrt(2.0 / std::numbers::pi) * resistance * rate}};
}

Power HydraulicStop::add_wrenches(const Instant& instant, std::span<const int> branches,
                                  std::span<Wrench> wrenches) const {
  const Line line = calc_line(instant);
  const Law law = calc_law(line, branches);
  const Eigen::Vector2d on_b = law.force * line.direction;
  wrenches[static_cast<std::size_t>(parameters_.marker_b)].force += on_b;
  wrenches[static_cast<std::size_t>(parameters_.marker_a)].force -= on_b;
  return {.dissipated = (law.force - law.elastic) * line.rate};
}

double HydraulicStop::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  return branches[0] == kApart ? 0.0 : parameters_.spring.integral(calc_line(instant).overlap);
}

void HydraulicStop::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Line line = calc_line(instant);
  const double half_band = 0.5 * kOverlapDeadBand, half_force_band = 0.5 * force_dead_band_;
  const bool is_apart = line.overlap <= (branches[0] == kApart ? half_band : -half_band);
  const bool was_without_force = branches[0] == kWithoutForce;
  branches[1] = parameters_.spring.choose_piece(branches[1], line.overlap, kOverlapDeadBand);
  branches[2] = parameters_.metering.choose_piece(branches[2], line.overlap, kOverlapDeadBand);
  const double least_rate = (branches[3] == kThroughOrifice ? -0.5 : 0.5) * kOverlapRateDeadBand;
  branches[3] = line.rate > least_rate ? kThroughOrifice : kThroughValve;
  branches[0] = kPushing;  // so that the law gives the sum of its parts
  const double least = was_without_force ? half_force_band : -half_force_band;
  branches[0] = is_apart ? kApart : calc_law(line, branches).sum > least ? kPushing : kWithoutForce;
}

void HydraulicStop::calc_switches(const Instant& instant, std::span<const int> branches,
                                  std::span<double> values) const {
  const Line line = calc_line(instant);
  std::fill(values.begin(), values.end(), 1.0);
  values[0] = kOverlapDeadBand + (branches[0] == kApart ? -line.overlap : line.overlap);
  if (branches[0] == kApart) return;
  const double sum = calc_law(line, branches).sum;
  values[1] = force_dead_band_ + (branches[0] == kPushing ? sum : -sum);
  if (!parameters_.metering.is_zero())
    values[2] = kOverlapRateDeadBand + (branches[3] == kThroughOrifice ? line.rate : -line.rate);
  const auto pieces = values.subspan(3);
  parameters_.spring.calc_piece_switches(branches[1], line.overlap, kOverlapDeadBand, pieces);
  parameters_.metering.calc_piece_switches(
      branches[2], line.overlap, kOverlapDeadBand,
      pieces.subspan(static_cast<std::size_t>(parameters_.spring.num_switches())));
}

ElementDescription HydraulicStop::describe() const {
  return {.points = {"a", "b"},
          .parameters = {{"contact_length", parameters_.contact_length, "m"},
                         {"spring", parameters_.spring, "N", "m"},
                         {"metering", parameters_.metering, "N s^2/m^2", "m"},
                         {"damping", parameters_.damping, "N s/m^2"}},
          .drawing = Drawing::kRod};
}

std::span<const Channel> HydraulicStop::channels() const {
  static constexpr std::array<Channel, 4> kChannels{{{"length", "m", ChannelRole::kExtent},
                                                     {"overlap", "m", ChannelRole::kDeflection},
                                                     {"rate", "m/s", ChannelRole::kRate},
                                                     {"force", "N", ChannelRole::kForce}}};
  return kChannels;
}

void HydraulicStop::calc_channels(const Instant& instant, std::span<const int> branches,
                                  std::span<double> values) const {
  const Line line = calc_line(instant);
  values[0] = line.length;
  values[1] = line.overlap;
  values[2] = line.rate;
  values[3] = calc_law(line, branches).force;
}

}  // namespace sprung::dynamics
