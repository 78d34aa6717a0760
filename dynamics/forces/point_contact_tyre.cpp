#include "dynamics/forces/point_contact_tyre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung::dynamics {

namespace {

// A switch is located to about 1e-13 s, on either side of the zero; what counts is where the motion goes from
// there.
constexpr double kLookAhead = 1e-9;  // s
// A pressed tyre lets go a trifle below zero force and presses again a trifle above it, so that the zero is
// passed once.
constexpr double kDeadBand = 1e-6;  // of the force at a penetration of 1 % of the radius

enum Contact : int { kInAir = 0, kPressed = 1, kTouching = 2 };

}  // namespace

struct PointContactTyre::Wheel {
  double distance;     // s along the road
  double road_height;  // h
  double road_rate;    // h′ ṡ
  double penetration;  // δ
  double rate;         // δ̇
  double elastic;      // spring part of the force
  double viscous;      // damper part of the force
  double force;        // on one wheel
};

PointContactTyre::PointContactTyre(std::string element_name, Parameters parameters, PlacedRoad road)
    : ForceElement(std::move(element_name)), parameters_(std::move(parameters)), road_(road) {
  dead_band_ = kDeadBand * std::abs(parameters_.spring.value(0.01 * parameters_.radius));
}

PointContactTyre::Wheel PointContactTyre::calc_wheel(const Instant& instant,
                                                     std::span<const int> branches) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  Wheel wheel{};
  wheel.distance = road_.distance(center.r.x());
  const RoadSample road = road_.road->sample(branches[1], wheel.distance);
  wheel.road_height = road.height;
  wheel.road_rate = road.slope * road_.direction * center.v.x();
  wheel.penetration = parameters_.radius - (center.r.y() - road.height);
  wheel.rate = wheel.road_rate - center.v.y();
  // Where contact ends is located; in a trial beyond, the spring's own formula goes on, so that all stays
  // smooth.
  wheel.elastic = parameters_.spring.value(wheel.penetration);
  wheel.viscous = parameters_.damping * wheel.rate;
  wheel.force = branches[0] == kPressed ? wheel.elastic + wheel.viscous : 0.0;
  return wheel;
}

Power PointContactTyre::add_wrenches(const Instant& instant, std::span<const int> branches,
                                     std::span<Wrench> wrenches) const {
  if (branches[0] == kInAir) return {};
  const Wheel wheel = calc_wheel(instant, branches);
  const double force = parameters_.multiplicity * wheel.force;
  wrenches[static_cast<std::size_t>(parameters_.marker)].force.y() += force;
  // Where the force is cut off at zero, what the spring gives back is lost.
  return {.dissipated = parameters_.multiplicity * (wheel.force - wheel.elastic) * wheel.rate,
          .input = force * wheel.road_rate};
}

double PointContactTyre::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  if (branches[0] == kInAir) return 0.0;
  return parameters_.multiplicity * parameters_.spring.integral(calc_wheel(instant, branches).penetration);
}

void PointContactTyre::choose_branches(const Instant& instant, std::span<int> branches) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double speed = road_.direction * center.v.x();
  branches[1] = road_.road->find_segment(road_.distance(center.r.x()) + kLookAhead * speed, speed >= 0.0);
  if (!parameters_.one_sided) {
    branches[0] = kPressed;
    return;
  }
  const Wheel wheel = calc_wheel(instant, branches);
  const double force = wheel.elastic + wheel.viscous;
  if (wheel.penetration + kLookAhead * wheel.rate <= 0.0) {
    branches[0] = kInAir;
  } else {
    const double half_band = 0.5 * dead_band_;
    branches[0] = force > (branches[0] == kTouching ? half_band : -half_band) ? kPressed : kTouching;
  }
}

void PointContactTyre::calc_switches(const Instant& instant, std::span<const int> branches,
                                     std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant, branches);
  const int segment = branches[1];
  values[0] = values[1] = 1.0;
  if (parameters_.one_sided) {
    const double force = wheel.elastic + wheel.viscous;
    values[0] = branches[0] == kInAir ? -wheel.penetration : wheel.penetration;
    if (branches[0] != kInAir) values[1] = dead_band_ + (branches[0] == kPressed ? force : -force);
  }
  values[2] = segment > 0 ? wheel.distance - road_.road->segment_end(segment - 1) : 1.0;
  values[3] =
      segment < road_.road->num_segments() - 1 ? road_.road->segment_end(segment) - wheel.distance : 1.0;
}

std::string PointContactTyre::describe_change(std::span<const int> old_branches,
                                              std::span<const int> new_branches) const {
  const bool was_on_ground = old_branches[0] != kInAir;
  const bool is_on_ground = new_branches[0] != kInAir;
  if (was_on_ground == is_on_ground) return {};
  return is_on_ground ? "touches the ground" : "leaves the ground";
}

double PointContactTyre::calc_longest_step(const Instant& instant) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double s = road_.distance(center.r.x());
  const double speed = std::abs(center.v.x());
  const double resolution = road_.road->resolution(road_.road->find_segment(s, true), s);
  return speed * 1e9 > resolution ? resolution / speed : std::numeric_limits<double>::infinity();
}

std::optional<RoadPlace> PointContactTyre::find_road_place(const Instant& instant,
                                                           std::span<const int> branches) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  return RoadPlace{.distance = road_.distance(center.r.x()), .is_pressed = branches[0] == kPressed};
}

void PointContactTyre::add_road_response(const Instant& instant, std::span<const int> branches,
                                         const RoadWave& wave, std::span<WrenchGain> wrenches,
                                         std::span<std::complex<double>> channels) const {
  using namespace std::complex_literals;
  const Wheel wheel = calc_wheel(instant, branches);
  const std::complex<double> rate = 1i * wave.frequency;
  const std::complex<double> force =
      parameters_.multiplicity * (parameters_.spring.slope(wheel.penetration) + parameters_.damping * rate);
  wrenches[static_cast<std::size_t>(parameters_.marker)].force.y() += force;
  channels[0] = force;
  channels[1] = 1.0;
  channels[2] = rate;
  channels[3] = 0.0;
  channels[4] = 1.0;
}

ElementDescription PointContactTyre::describe() const {
  return {.points = {"wheel"},
          .parameters = {{"contact", std::string("point")},
                         {"radius", parameters_.radius, "m"},
                         {"multiplicity", parameters_.multiplicity, "1"},
                         {"spring", parameters_.spring, "N", "m"},
                         {"damping", parameters_.damping, "N s/m"},
                         {"one_sided", parameters_.one_sided}},
          .drawing = Drawing::kWheel,
          .on_road = true};
}

std::span<const Channel> PointContactTyre::channels() const {
  static constexpr std::array<Channel, 5> kChannels{{{"force", "N", ChannelRole::kForce},
                                                     {"penetration", "m", ChannelRole::kDeflection},
                                                     {"rate", "m/s", ChannelRole::kRate},
                                                     {"contact", "1", ChannelRole::kContact},
                                                     {"road_height", "m", ChannelRole::kRoadHeight}}};
  return kChannels;
}

void PointContactTyre::calc_channels(const Instant& instant, std::span<const int> branches,
                                     std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant, branches);
  values[0] = parameters_.multiplicity * wheel.force;
  values[1] = wheel.penetration;
  values[2] = wheel.rate;
  values[3] = branches[0] == kInAir ? 0.0 : 1.0;
  values[4] = wheel.road_height;
}

}  // namespace sprung::dynamics
