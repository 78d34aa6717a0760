#include "dynamics/forces/distributed_tyre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sprung::dynamics {

namespace {

// As for the point-contact tyre.
constexpr double kLookAhead = 1e-9;  // s
constexpr double kDeadBand = 1e-6;   // of the force at a penetration of 1 % of the radius

constexpr double kCellsPerRadius = 24.0;  // samples of the road under the wheel
constexpr double kMostCells = 1000.0;

enum Contact : int { kInAir = 0, kPressed = 1, kTouching = 2 };

int count_cells(const Road& road, double radius) {
  double cell = radius / kCellsPerRadius;
  for (int k = 0; k < road.num_segments(); ++k) {
    const double inside = k == 0 ? road.segment_end(0) : road.segment_end(k - 1);
    if (std::isfinite(inside)) cell = std::min(cell, road.resolution(k, inside));
  }
  return static_cast<int>(std::min(kMostCells, std::ceil(2.0 * radius / cell)));
}

}  // namespace

struct DistributedTyre::Wheel {
  WheelOverlap overlap;
  double height;       // of the centre
  double penetration;  // δ
  double rate;         // δ̇
  double depth_rate;   // of the deepest place
  double elastic, viscous;
  double lift, drag;   // of the vertical and of the backward force in the force's size
  double level_width;  // of contact at δ on level ground
};

DistributedTyre::DistributedTyre(std::string element_name, Parameters parameters, PlacedRoad road)
    : ForceElement(std::move(element_name)),
      parameters_(std::move(parameters)),
      road_(road),
      num_cells_(count_cells(*road.road, parameters_.radius)) {
  dead_band_ = kDeadBand * std::abs(parameters_.spring.value(0.01 * parameters_.radius));
}

DistributedTyre::Wheel DistributedTyre::calc_wheel(const Instant& instant) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double radius = parameters_.radius;
  Wheel wheel{};
  wheel.height = center.r.y();
  wheel.overlap =
      calc_wheel_overlap(*road_.road, road_.distance(center.r.x()), center.r.y(), radius, num_cells_);
  const WheelOverlap& overlap = wheel.overlap;
  wheel.penetration = find_level_penetration(radius, overlap.area);
  wheel.level_width = 2.0 * std::sqrt(wheel.penetration * (2.0 * radius - wheel.penetration));
  const bool touches = wheel.level_width > 0.0;
  // Where it only just touches: in one point.
  wheel.lift = touches ? overlap.width / wheel.level_width : 1.0;
  wheel.drag = touches ? overlap.rise / wheel.level_width : overlap.depth_slope;
  const double speed = road_.direction * center.v.x();
  wheel.rate = wheel.drag * speed - wheel.lift * center.v.y();
  wheel.depth_rate = overlap.depth_slope * speed - center.v.y();
  wheel.elastic = parameters_.spring.value(wheel.penetration);
  wheel.viscous = parameters_.damping * wheel.rate;
  return wheel;
}

double DistributedTyre::front(const Instant& instant) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double speed = road_.direction * center.v.x();
  return road_.distance(center.r.x()) + std::copysign(parameters_.radius, speed);
}

Power DistributedTyre::add_wrenches(const Instant& instant, std::span<const int> branches,
                                    std::span<Wrench> wrenches) const {
  if (branches[0] != kPressed) {
    if (branches[0] == kInAir) return {};
    // Touching without force: what the spring gives back is lost.
    const Wheel wheel = calc_wheel(instant);
    return {.dissipated = -parameters_.multiplicity * wheel.elastic * wheel.rate};
  }
  const Wheel wheel = calc_wheel(instant);
  const double force = parameters_.multiplicity * (wheel.elastic + wheel.viscous);
  wrenches[static_cast<std::size_t>(parameters_.marker)].force +=
      force * Eigen::Vector2d(-road_.direction * wheel.drag, wheel.lift);
  return {.dissipated = parameters_.multiplicity * wheel.viscous * wheel.rate};
}

double DistributedTyre::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  if (branches[0] == kInAir) return 0.0;
  return parameters_.multiplicity * parameters_.spring.integral(calc_wheel(instant).penetration);
}

void DistributedTyre::choose_branches(const Instant& instant, std::span<int> branches) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double speed = road_.direction * center.v.x();
  branches[1] = road_.road->find_segment(front(instant) + kLookAhead * speed, speed >= 0.0);
  const Wheel wheel = calc_wheel(instant);
  if (wheel.overlap.depth + kLookAhead * wheel.depth_rate <= 0.0) {
    branches[0] = kInAir;
  } else {
    const double half_band = 0.5 * dead_band_;
    branches[0] = wheel.elastic + wheel.viscous > (branches[0] == kTouching ? half_band : -half_band)
                      ? kPressed
                      : kTouching;
  }
}

void DistributedTyre::calc_switches(const Instant& instant, std::span<const int> branches,
                                    std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant);
  const int segment = branches[1];
  const double force = wheel.elastic + wheel.viscous;
  values[0] = branches[0] == kInAir ? -wheel.overlap.depth : wheel.overlap.depth;
  values[1] = branches[0] == kInAir ? 1.0 : dead_band_ + (branches[0] == kPressed ? force : -force);
  values[2] = segment > 0 ? front(instant) - road_.road->segment_end(segment - 1) : 1.0;
  values[3] =
      segment < road_.road->num_segments() - 1 ? road_.road->segment_end(segment) - front(instant) : 1.0;
}

std::string DistributedTyre::describe_change(std::span<const int> old_branches,
                                             std::span<const int> new_branches) const {
  const bool was_on_ground = old_branches[0] != kInAir;
  const bool is_on_ground = new_branches[0] != kInAir;
  if (was_on_ground == is_on_ground) return {};
  return is_on_ground ? "touches the ground" : "leaves the ground";
}

double DistributedTyre::calc_longest_step(const Instant& instant) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  const double s = road_.distance(center.r.x());
  const double speed = std::abs(center.v.x());
  double resolution = std::numeric_limits<double>::infinity();
  const int first = road_.road->find_segment(s - parameters_.radius, true);
  const int last = road_.road->find_segment(s + parameters_.radius, true);
  for (int k = first; k <= last; ++k) resolution = std::min(resolution, road_.road->resolution(k, s));
  return speed * 1e9 > resolution ? resolution / speed : std::numeric_limits<double>::infinity();
}

std::optional<RoadPlace> DistributedTyre::find_road_place(const Instant& instant,
                                                          std::span<const int> branches) const {
  const MarkerState& center = instant.markers[static_cast<std::size_t>(parameters_.marker)];
  return RoadPlace{.distance = road_.distance(center.r.x()), .is_pressed = branches[0] == kPressed};
}

void DistributedTyre::add_road_response(const Instant& instant, std::span<const int> /*branches*/,
                                        const RoadWave& wave, std::span<WrenchGain> wrenches,
                                        std::span<std::complex<double>> channels) const {
  using namespace std::complex_literals;
  const Wheel wheel = calc_wheel(instant);
  const double half_width = 0.5 * wheel.level_width, angle = wave.wavenumber * half_width;
  const double mean_height = angle > 0.0 ? std::sin(angle) / angle : 1.0;  // over what touches
  // A higher edge moves outwards, by its height over the slope a/(R − δ) at which the circle leaves the
  // ground.
  const double lift =
      (std::cos(angle) - mean_height) * (parameters_.radius - wheel.penetration) / (half_width * half_width);
  const std::complex<double> drag = 1i * std::sin(angle) / half_width;
  const std::complex<double> rate = 1i * wave.frequency * mean_height;
  const double standing = parameters_.multiplicity * wheel.elastic;
  const std::complex<double> vertical =
      standing * lift +
      parameters_.multiplicity *
          (parameters_.spring.slope(wheel.penetration) * mean_height + parameters_.damping * rate);
  const std::complex<double> along = -road_.direction * standing * drag;
  wrenches[static_cast<std::size_t>(parameters_.marker)].force += Eigen::Vector2cd(along, vertical);
  channels[0] = vertical;
  channels[1] = mean_height;
  channels[2] = rate;
  channels[3] = 0.0;
  channels[4] = mean_height;
  channels[5] = along;
}

ElementDescription DistributedTyre::describe() const {
  return {.points = {"wheel"},
          .parameters = {{"contact", std::string("distributed")},
                         {"radius", parameters_.radius, "m"},
                         {"multiplicity", parameters_.multiplicity, "1"},
                         {"spring", parameters_.spring, "N", "m"},
                         {"damping", parameters_.damping, "N s/m"},
                         {"one_sided", true}},
          .drawing = Drawing::kWheel,
          .on_road = true};
}

std::span<const Channel> DistributedTyre::channels() const {
  static constexpr std::array<Channel, 6> kChannels{
      {{"force", "N", ChannelRole::kForce},
       {"penetration", "m", ChannelRole::kDeflection},
       {"rate", "m/s", ChannelRole::kRate},
       {"contact", "1", ChannelRole::kContact},
       {"road_height", "m", ChannelRole::kRoadHeight},
       {"longitudinal_force", "N", ChannelRole::kLongitudinalForce}}};
  return kChannels;
}

void DistributedTyre::calc_channels(const Instant& instant, std::span<const int> branches,
                                    std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant);
  const double force =
      branches[0] == kPressed ? parameters_.multiplicity * (wheel.elastic + wheel.viscous) : 0.0;
  values[0] = force * wheel.lift;
  values[1] = wheel.penetration;
  values[2] = wheel.rate;
  values[3] = branches[0] == kInAir ? 0.0 : 1.0;
  values[4] = wheel.height - parameters_.radius +
              (wheel.overlap.area > 0.0 ? wheel.penetration : wheel.overlap.depth);
  values[5] = -road_.direction * force * wheel.drag;
}

}  // namespace sprung::dynamics
