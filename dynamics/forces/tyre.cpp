#include "dynamics/forces/tyre.h"

#include <array>
#include <cmath>

namespace sprung::dynamics {

namespace {

// A switch is located to about 1e-13 s, before or after the zero. So the branches are chosen by the motion
// that follows a little later.
constexpr double kLookAhead = 1e-9;  // s
// A pressed tyre is released a little below zero force and pressed again a little above it, so that one
// passage through zero gives one switch.
constexpr double kForceDeadBand = 1e-6;  // of the force at a penetration of 1 % of the radius

}  // namespace

Tyre::Tyre(std::string element_name, Parameters parameters, PlacedRoad road)
    : ForceElement(std::move(element_name)),
      parameters_(std::move(parameters)),
      road_(road),
      dead_band_(kForceDeadBand * std::abs(parameters_.spring.value(0.01 * parameters_.radius))) {}

double Tyre::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  if (branches[0] == kInAir) return 0.0;
  return parameters_.multiplicity *
         parameters_.spring.integral(measure_contact(instant, branches).penetration);
}

void Tyre::choose_branches(const Instant& instant, std::span<int> branches) const {
  const double speed = road_.direction * center(instant).v.x();
  branches[1] = road_.road->find_segment(calc_front(instant) + kLookAhead * speed, speed >= 0.0);
  if (!parameters_.one_sided) {
    branches[0] = kPressed;
    return;
  }
  const ContactMeasures contact = measure_contact(instant, branches);
  if (contact.depth + kLookAhead * contact.depth_rate <= 0.0) {
    branches[0] = kInAir;
  } else {
    const double half_band = 0.5 * dead_band_;
    branches[0] = contact.force > (branches[0] == kTouching ? half_band : -half_band) ? kPressed : kTouching;
  }
}

void Tyre::calc_switches(const Instant& instant, std::span<const int> branches,
                         std::span<double> values) const {
  values[0] = values[1] = 1.0;
  if (parameters_.one_sided) {
    const ContactMeasures contact = measure_contact(instant, branches);
    values[0] = branches[0] == kInAir ? -contact.depth : contact.depth;
    if (branches[0] != kInAir)
      values[1] = dead_band_ + (branches[0] == kPressed ? contact.force : -contact.force);
  }
  const int segment = branches[1];
  const double front = calc_front(instant);
  values[2] = segment > 0 ? front - road_.road->segment_end(segment - 1) : 1.0;
  values[3] = segment < road_.road->num_segments() - 1 ? road_.road->segment_end(segment) - front : 1.0;
}

std::string Tyre::describe_change(std::span<const int> old_branches,
                                  std::span<const int> new_branches) const {
  const bool was_on_ground = old_branches[0] != kInAir;
  const bool is_on_ground = new_branches[0] != kInAir;
  if (was_on_ground == is_on_ground) return {};
  return is_on_ground ? "touches the ground" : "leaves the ground";
}

std::optional<RoadPlace> Tyre::find_road_place(const Instant& instant, std::span<const int> branches) const {
  return RoadPlace{.distance = road_.distance(center(instant).r.x()),
                   .is_pressed = branches[0] == kPressed,
                   .can_lift = parameters_.one_sided};
}

double Tyre::calc_passing_time(const Instant& instant, double length) const {
  const double speed = std::abs(center(instant).v.x());
  return speed * 1e9 > length ? length / speed : std::numeric_limits<double>::infinity();
}

ElementDescription Tyre::describe_as(const char* contact) const {
  return {.points = {"wheel"},
          .parameters = {{"contact", std::string(contact)},
                         {"radius", parameters_.radius, "m"},
                         {"multiplicity", parameters_.multiplicity, "1"},
                         {"spring", parameters_.spring, "N", "m"},
                         {"damping", parameters_.damping, "N s/m"},
                         {"one_sided", parameters_.one_sided}},
          .drawing = Drawing::kWheel,
          .on_road = true};
}

std::span<const Channel> Tyre::all_channels() {
  static constexpr std::array<Channel, 6> kChannels{
      {{"force", "N", ChannelRole::kForce},
       {"penetration", "m", ChannelRole::kDeflection},
       {"rate", "m/s", ChannelRole::kRate},
       {"contact", "1", ChannelRole::kContact},
       {"road_height", "m", ChannelRole::kRoadHeight},
       {"longitudinal_force", "N", ChannelRole::kLongitudinalForce}}};
  return kChannels;
}

}  // namespace sprung::dynamics
