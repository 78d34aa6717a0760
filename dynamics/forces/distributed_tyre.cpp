#include "dynamics/forces/distributed_tyre.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/forces/wheel_overlap.h"

namespace sprung::dynamics {

namespace {

constexpr double kCellsPerRadius = 24.0;  // samples of the road under the wheel
constexpr double kMostCells = 1000.0;

int count_cells(const Road& road, double radius) {
  double cell = radius / kCellsPerRadius;
  for (int k = 0; k < road.num_segments(); ++k) {
    const double inside = k == 0 ? road.segment_end(0) : road.segment_end(k - 1);
    if (std::isfinite(inside)) cell = std::min(cell, road.finest_resolution(k));
  }
  return static_cast<int>(std::min(kMostCells, std::ceil(2.0 * radius / cell)));
}

}  // namespace

struct DistributedTyre::Wheel {
  WheelOverlap overlap;
  double height;       // of the centre
  double penetration;  // δ
  double rate;         // δ̇
  double depth_rate;   // rate of overlap.depth
  double elastic, viscous;
  double lift, drag;   // vertical and backward part of the force, divided by its size
  double level_width;  // width of contact on level ground at δ
};

DistributedTyre::DistributedTyre(std::string element_name, Parameters parameters, PlacedRoad road)
    : Tyre(std::move(element_name), std::move(parameters), road),
      num_cells_(count_cells(*road.road, this->parameters().radius)) {
  if (!this->parameters().one_sided)
    throw std::invalid_argument("DistributedTyre: one_sided is false, but this tyre cannot pull");
}

DistributedTyre::Wheel DistributedTyre::calc_wheel(const Instant& instant) const {
  const MarkerState& center = this->center(instant);
  const double radius = parameters().radius;
  Wheel wheel{};
  wheel.height = center.r.y();
  wheel.overlap =
      calc_wheel_overlap(*road().road, road().distance(center.r.x()), center.r.y(), radius, num_cells_);
  const WheelOverlap& overlap = wheel.overlap;
  wheel.penetration = find_level_penetration(radius, overlap.area);
  wheel.level_width = 2.0 * std::sqrt(wheel.penetration * (2.0 * radius - wheel.penetration));
  const bool touches = wheel.level_width > 0.0;
  // A wheel that only just touches has contact in one point.
  wheel.lift = touches ? overlap.width / wheel.level_width : 1.0;
  wheel.drag = touches ? overlap.rise / wheel.level_width : overlap.depth_slope;
  const double speed = road().direction * center.v.x();
  wheel.rate = wheel.drag * speed - wheel.lift * center.v.y();
  wheel.depth_rate = overlap.depth_slope * speed - center.v.y();
  wheel.elastic = parameters().spring.value(wheel.penetration);
  wheel.viscous = parameters().damping * wheel.rate;
  return wheel;
}

double DistributedTyre::calc_front(const Instant& instant) const {
  const MarkerState& center = this->center(instant);
  const double speed = road().direction * center.v.x();
  return road().distance(center.r.x()) + std::copysign(parameters().radius, speed);
}

Power DistributedTyre::add_wrenches(const Instant& instant, std::span<const int> branches,
                                    std::span<Wrench> wrenches) const {
  if (branches[0] != kPressed) {
    if (branches[0] == kInAir) return {};
    // Touching without force: the energy that the spring releases is dissipated.
    const Wheel wheel = calc_wheel(instant);
    return {.dissipated = -parameters().multiplicity * wheel.elastic * wheel.rate};
  }
  const Wheel wheel = calc_wheel(instant);
  const double force = parameters().multiplicity * (wheel.elastic + wheel.viscous);
  wrenches[static_cast<std::size_t>(parameters().marker)].force +=
      force * Eigen::Vector2d(-road().direction * wheel.drag, wheel.lift);
  return {.dissipated = parameters().multiplicity * wheel.viscous * wheel.rate};
}

DistributedTyre::ContactMeasures DistributedTyre::measure_contact(const Instant& instant,
                                                                  std::span<const int> /*branches*/) const {
  const Wheel wheel = calc_wheel(instant);
  return {.penetration = wheel.penetration,
          .depth = wheel.overlap.depth,
          .depth_rate = wheel.depth_rate,
          .force = wheel.elastic + wheel.viscous};
}

double DistributedTyre::calc_longest_step(const Instant& instant) const {
  const Road& profile = *road().road;
  const double s = road().distance(center(instant).r.x());
  double resolution = std::numeric_limits<double>::infinity();
  const int first = profile.find_segment(s - parameters().radius, true);
  const int last = profile.find_segment(s + parameters().radius, true);
  for (int k = first; k <= last; ++k) resolution = std::min(resolution, profile.finest_resolution(k));
  return calc_passing_time(instant, resolution);
}

void DistributedTyre::add_road_response(const Instant& instant, std::span<const int> /*branches*/,
                                        const RoadWave& wave, std::span<WrenchGain> wrenches,
                                        std::span<std::complex<double>> channels) const {
  using namespace std::complex_literals;
  const Wheel wheel = calc_wheel(instant);
  const double half_width = 0.5 * wheel.level_width, angle = wave.wavenumber * half_width;
  const double mean_height = angle > 0.0 ? std::sin(angle) / angle : 1.0;  // over the length of contact
  // An end of the contact whose road is higher moves outwards by this height divided by the slope a/(R − δ)
  // of the circle there.
  const double lift =
      (std::cos(angle) - mean_height) * (parameters().radius - wheel.penetration) / (half_width * half_width);
  const std::complex<double> drag = 1i * std::sin(angle) / half_width;
  const std::complex<double> rate = 1i * wave.frequency * mean_height;
  const double standing = parameters().multiplicity * wheel.elastic;
  const std::complex<double> vertical =
      standing * lift +
      parameters().multiplicity *
          (parameters().spring.slope(wheel.penetration) * mean_height + parameters().damping * rate);
  const std::complex<double> along = -road().direction * standing * drag;
  wrenches[static_cast<std::size_t>(parameters().marker)].force += Eigen::Vector2cd(along, vertical);
  channels[0] = vertical;
  channels[1] = mean_height;
  channels[2] = rate;
  channels[3] = 0.0;
  channels[4] = mean_height;
  channels[5] = along;
}

void DistributedTyre::calc_channels(const Instant& instant, std::span<const int> branches,
                                    std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant);
  const double force =
      branches[0] == kPressed ? parameters().multiplicity * (wheel.elastic + wheel.viscous) : 0.0;
  values[0] = force * wheel.lift;
  values[1] = wheel.penetration;
  values[2] = wheel.rate;
  values[3] = branches[0] == kInAir ? 0.0 : 1.0;
  values[4] = wheel.height - parameters().radius +
              (wheel.overlap.area > 0.0 ? wheel.penetration : wheel.overlap.depth);
  values[5] = -road().direction * force * wheel.drag;
}

}  // namespace sprung::dynamics
