#include "dynamics/forces/bushing.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "dynamics/functions/mean_slope.h"

namespace sprung::dynamics {

namespace {

// How far a piece is used beyond its end, as for springs and dampers.
constexpr double kBushingDeadBand = 1e-9;      // m or rad
constexpr double kBushingRateDeadBand = 1e-6;  // m/s or rad/s
// R.m.s. rate that the linearisation for random motion begins with.
constexpr double kUsualBushingRate = 0.1;  // m/s or rad/s
constexpr std::array<const char*, 3> kDirectionNames{"x", "y", "rotation"};

}  // namespace

// The motion of b as seen from a.
struct Bushing::Relative {
  FrameRotation axes;
  Eigen::Vector2d span;  // from a to b, world axes
  Eigen::Vector3d u, rate;
};

Bushing::Bushing(std::string element_name, Parameters parameters)
    : ForceElement(std::move(element_name)), parameters_(std::move(parameters)) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Direction& direction = parameters_.directions[k];
    num_switches_ += direction.spring.num_switches() + direction.damper.num_switches();
    if (direction.relaxing_stiffness > 0.0) relaxing_.push_back(k);
  }
}

// The axes turn with a, which bears the torque of the forces; b bears that of the third law alone.
std::vector<int> Bushing::turned_markers() const {
  const Direction& rotation = parameters_.directions[2];
  const bool has_law =
      !rotation.spring.is_zero() || !rotation.damper.is_zero() || rotation.relaxing_stiffness > 0.0;
  return has_law ? markers() : std::vector<int>{parameters_.marker_a};
}

// √(N k_r): the state is this times the deflection of the spring.
double Bushing::calc_state_factor(std::size_t k) const {
  return std::sqrt(parameters_.multiplicity * parameters_.directions[k].relaxing_stiffness);
}

std::vector<InternalState> Bushing::internal_states() const {
  std::vector<InternalState> states;
  for (const std::size_t k : relaxing_) {
    states.push_back({.name = std::string("relaxation_") + kDirectionNames[k],
                      .size = calc_state_factor(k),
                      .is_per_length = k < 2});
  }
  return states;
}

void Bushing::calc_state_rates(const Instant& instant, std::span<const int> /*branches*/,
                               std::span<double> rates) const {
  const Relative relative = calc_relative(instant);
  for (std::size_t i = 0; i < relaxing_.size(); ++i) {
    const std::size_t k = relaxing_[i];
    rates[i] = calc_state_factor(k) * relative.rate[static_cast<Eigen::Index>(k)] -
               instant.states[i] / parameters_.directions[k].relaxation_time;
  }
}

std::vector<DeflectionLaw> Bushing::deflection_laws() const {
  std::vector<DeflectionLaw> laws;
  for (std::size_t k = 0; k < 3; ++k) laws.push_back({k, &parameters_.directions[k].spring});
  return laws;
}

RandomLaws Bushing::linearise_for_random_motion(const Instant& /*at_rest*/, std::span<const int> /*branches*/,
                                                std::span<const double> rms) const {
  const auto is_linear = [](const Direction& direction) { return has_one_slope(direction.damper); };
  if (std::all_of(parameters_.directions.begin(), parameters_.directions.end(), is_linear)) return {};
  RandomLaws laws;
  for (std::size_t k = 0; k < 3; ++k) {
    const double rate = rms.empty() ? kUsualBushingRate : rms[3 + k];
    laws.rate_slopes.push_back(parameters_.multiplicity *
                               calc_mean_slope(parameters_.directions[k].damper, rate));
  }
  return laws;
}

Bushing::Relative Bushing::calc_relative(const Instant& instant) const {
  const MarkerState& a = instant.markers[static_cast<std::size_t>(parameters_.marker_a)];
  const MarkerState& b = instant.markers[static_cast<std::size_t>(parameters_.marker_b)];
  Relative relative;
  relative.axes = FrameRotation::from_angle(a.angle + parameters_.angle);
  const double cosine = relative.axes.cosine, sine = relative.axes.sine;
  relative.span = b.r - a.r;
  const Eigen::Vector2d v = b.v - a.v;
  const double x = cosine * relative.span.x() + sine * relative.span.y();
  const double y = cosine * relative.span.y() - sine * relative.span.x();
  relative.u = {x - parameters_.free_position.x(), y - parameters_.free_position.y(),
                b.angle - a.angle - parameters_.free_angle};
  relative.rate = {cosine * v.x() + sine * v.y() + a.omega * y, cosine * v.y() - sine * v.x() - a.omega * x,
                   b.omega - a.omega};
  return relative;
}

Power Bushing::add_wrenches(const Instant& instant, std::span<const int> branches,
                            std::span<Wrench> wrenches) const {
  const Relative relative = calc_relative(instant);
  Eigen::Vector3d on_b;  // in the axes of the bushing
  Power power;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Direction& direction = parameters_.directions[k];
    const double spring =
        parameters_.multiplicity * direction.spring.value_in_piece(branches[2 * k], relative.u[i]);
    const double damper = instant.rate_slopes.empty()
                              ? parameters_.multiplicity *
                                    direction.damper.value_in_piece(branches[2 * k + 1], relative.rate[i])
                              : instant.rate_slopes[k] * relative.rate[i];
    on_b[i] = -(spring + damper);
    power.dissipated += damper * relative.rate[i];
  }
  for (std::size_t i = 0; i < relaxing_.size(); ++i) {
    const std::size_t k = relaxing_[i];
    on_b[static_cast<Eigen::Index>(k)] -= calc_state_factor(k) * instant.states[i];
    power.dissipated += instant.states[i] * instant.states[i] / parameters_.directions[k].relaxation_time;
  }
  const double cosine = relative.axes.cosine, sine = relative.axes.sine;
  const Eigen::Vector2d force(cosine * on_b[0] - sine * on_b[1], sine * on_b[0] + cosine * on_b[1]);
  Wrench& wrench_a = wrenches[static_cast<std::size_t>(parameters_.marker_a)];
  Wrench& wrench_b = wrenches[static_cast<std::size_t>(parameters_.marker_b)];
  wrench_b.force += force;
  wrench_b.torque += on_b[2];
  wrench_a.force -= force;
  wrench_a.torque -= on_b[2] + relative.span.x() * force.y() - relative.span.y() * force.x();
  return power;
}

double Bushing::calc_stored_energy(const Instant& instant, std::span<const int> /*branches*/) const {
  const Relative relative = calc_relative(instant);
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    sum += parameters_.directions[k].spring.integral(relative.u[static_cast<Eigen::Index>(k)]);
  sum *= parameters_.multiplicity;
  for (const double state : instant.states) sum += 0.5 * state * state;
  return sum;
}

void Bushing::choose_branches(const Instant& instant, std::span<int> branches) const {
  const Relative relative = calc_relative(instant);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Direction& direction = parameters_.directions[k];
    int &spring = branches[2 * k], &damper = branches[2 * k + 1];
    spring = direction.spring.choose_piece(spring, relative.u[i], kBushingDeadBand);
    damper = direction.damper.choose_piece(damper, relative.rate[i], kBushingRateDeadBand);
  }
}

void Bushing::calc_switches(const Instant& instant, std::span<const int> branches,
                            std::span<double> values) const {
  const Relative relative = calc_relative(instant);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Direction& direction = parameters_.directions[k];
    direction.spring.calc_piece_switches(branches[2 * k], relative.u[i], kBushingDeadBand, values);
    values = values.subspan(static_cast<std::size_t>(direction.spring.num_switches()));
    direction.damper.calc_piece_switches(branches[2 * k + 1], relative.rate[i], kBushingRateDeadBand, values);
    values = values.subspan(static_cast<std::size_t>(direction.damper.num_switches()));
  }
}

ElementDescription Bushing::describe() const {
  const bool is_apart = !parameters_.free_position.isZero();  // a spring of some length, as that of a wheel
  ElementDescription description{.points = {"a", "b"},
                                 .parameters = {{"angle", parameters_.angle, "rad"},
                                                {"free_position", parameters_.free_position, "m"},
                                                {"free_angle", parameters_.free_angle, "rad"},
                                                {"multiplicity", parameters_.multiplicity, "1"}},
                                 .drawing = is_apart ? Drawing::kSpring : Drawing::kPin};
  for (std::size_t k = 0; k < 3; ++k) {
    const Direction& direction = parameters_.directions[k];
    const std::string suffix = std::string("_") + kDirectionNames[k];
    const bool turns = k == 2;
    description.parameters.push_back(
        {"spring" + suffix, direction.spring, turns ? "N m" : "N", turns ? "rad" : "m"});
    description.parameters.push_back(
        {"damper" + suffix, direction.damper, turns ? "N m" : "N", turns ? "rad/s" : "m/s"});
    if (direction.relaxing_stiffness == 0.0) continue;
    description.parameters.push_back(
        {"relaxing_stiffness" + suffix, direction.relaxing_stiffness, turns ? "N m/rad" : "N/m"});
    description.parameters.push_back({"relaxation_time" + suffix, direction.relaxation_time, "s"});
  }
  return description;
}

std::span<const Channel> Bushing::channels() const {
  static constexpr std::array<Channel, 9> kChannels{{{"deflection_x", "m", ChannelRole::kDeflection},
                                                     {"deflection_y", "m", ChannelRole::kDeflection},
                                                     {"deflection_rotation", "rad", ChannelRole::kDeflection},
                                                     {"rate_x", "m/s", ChannelRole::kRate},
                                                     {"rate_y", "m/s", ChannelRole::kRate},
                                                     {"rate_rotation", "rad/s", ChannelRole::kRate},
                                                     {"force_x", "N", ChannelRole::kForce},
                                                     {"force_y", "N", ChannelRole::kForce},
                                                     {"torque", "N m", ChannelRole::kTorque}}};
  return kChannels;
}

void Bushing::calc_channels(const Instant& instant, std::span<const int> /*branches*/,
                            std::span<double> values) const {
  const Relative relative = calc_relative(instant);
  for (std::size_t k = 0; k < 3; ++k) {
    const double u = relative.u[static_cast<Eigen::Index>(k)];
    const double rate = relative.rate[static_cast<Eigen::Index>(k)];
    const Direction& direction = parameters_.directions[k];
    values[k] = u;
    values[3 + k] = rate;
    const double damper = instant.rate_slopes.empty()
                              ? parameters_.multiplicity * direction.damper.value(rate)
                              : instant.rate_slopes[k] * rate;
    values[6 + k] = -parameters_.multiplicity * direction.spring.value(u) - damper;
  }
  for (std::size_t i = 0; i < relaxing_.size(); ++i)
    values[6 + relaxing_[i]] -= calc_state_factor(relaxing_[i]) * instant.states[i];
}

}  // namespace sprung::dynamics
