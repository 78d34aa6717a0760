#include "dynamics/forces/point_contact_tyre.h"

namespace sprung::dynamics {

struct PointContactTyre::Wheel {
  double road_height;  // h
  double road_rate;    // h′ ṡ
  double penetration;  // δ
  double rate;         // δ̇
  double elastic;      // spring part of the force
  double viscous;      // damper part of the force
  double force;        // on one wheel
};

PointContactTyre::Wheel PointContactTyre::calc_wheel(const Instant& instant,
                                                     std::span<const int> branches) const {
  const MarkerState& center = this->center(instant);
  Wheel wheel{};
  const RoadSample sample = road().road->sample(branches[1], road().distance(center.r.x()));
  wheel.road_height = sample.height;
  wheel.road_rate = sample.slope * road().direction * center.v.x();
  wheel.penetration = parameters().radius - (center.r.y() - sample.height);
  wheel.rate = wheel.road_rate - center.v.y();
  // The end of contact is located. A trial beyond it uses the same formula of the spring, so that the force
  // stays smooth.
  wheel.elastic = parameters().spring.value(wheel.penetration);
  wheel.viscous = parameters().damping * wheel.rate;
  wheel.force = branches[0] == kPressed ? wheel.elastic + wheel.viscous : 0.0;
  return wheel;
}

Power PointContactTyre::add_wrenches(const Instant& instant, std::span<const int> branches,
                                     std::span<Wrench> wrenches) const {
  if (branches[0] == kInAir) return {};
  const Wheel wheel = calc_wheel(instant, branches);
  const double force = parameters().multiplicity * wheel.force;
  wrenches[static_cast<std::size_t>(parameters().marker)].force.y() += force;
  // While the force is kept at zero, the energy that the spring releases is dissipated.
  return {.dissipated = parameters().multiplicity * (wheel.force - wheel.elastic) * wheel.rate,
          .input = force * wheel.road_rate};
}

PointContactTyre::ContactMeasures PointContactTyre::measure_contact(const Instant& instant,
                                                                    std::span<const int> branches) const {
  const Wheel wheel = calc_wheel(instant, branches);
  return {.penetration = wheel.penetration,
          .depth = wheel.penetration,
          .depth_rate = wheel.rate,
          .force = wheel.elastic + wheel.viscous};
}

double PointContactTyre::calc_longest_step(const Instant& instant) const {
  const double s = calc_front(instant);
  return calc_passing_time(instant, road().road->resolution(road().road->find_segment(s, true), s));
}

void PointContactTyre::add_road_response(const Instant& instant, std::span<const int> branches,
                                         const RoadWave& wave, std::span<WrenchGain> wrenches,
                                         std::span<std::complex<double>> channels) const {
  using namespace std::complex_literals;
  const Wheel wheel = calc_wheel(instant, branches);
  const std::complex<double> rate = 1i * wave.frequency;
  const std::complex<double> force =
      parameters().multiplicity *
      (parameters().spring.slope(wheel.penetration) + parameters().damping * rate);
  wrenches[static_cast<std::size_t>(parameters().marker)].force.y() += force;
  channels[0] = force;
  channels[1] = 1.0;
  channels[2] = rate;
  channels[3] = 0.0;
  channels[4] = 1.0;
}

void PointContactTyre::calc_channels(const Instant& instant, std::span<const int> branches,
                                     std::span<double> values) const {
  const Wheel wheel = calc_wheel(instant, branches);
  values[0] = parameters().multiplicity * wheel.force;
  values[1] = wheel.penetration;
  values[2] = wheel.rate;
  values[3] = branches[0] == kInAir ? 0.0 : 1.0;
  values[4] = wheel.road_height;
}

}  // namespace sprung::dynamics
