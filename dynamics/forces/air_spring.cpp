#include "dynamics/forces/air_spring.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace sprung::dynamics {

namespace {

// How far a branch is used beyond its end, as for springs.
constexpr double kValveDeadBand = 1e-9;  // m
// The natural size of the logarithm of a density: that of 5 % of the pressure.
constexpr double kNaturalLogarithm = 0.05;
// R.m.s. value of ln(ρ_i/ρ_j) that the linearisation for random motion begins with, and the least.
constexpr double kUsualImbalance = 0.01, kLeastImbalance = 1e-9;

}  // namespace

// Of one bellows.
struct AirSpring::Motion {
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // from a to b
  double height = 0.0, rate = 0.0;                      // rate of the height
};

// Of the chambers of one of the springs side by side.
struct AirSpring::Gas {
  std::array<Motion, 2> motion;
  std::array<double, 2> area{};
  std::array<double, kMostChambers> volume{}, x{}, mass{}, inflow{};
  std::array<double, kMostChambers - 1> flow{};  // through the passages
  double total_mass = 0.0, valve_flow = 0.0, opening = 0.0;
};

AirSpring::AirSpring(std::string element_name, Parameters parameters)
    : ForceElement(std::move(element_name)),
      parameters_(std::move(parameters)),
      gas_(parameters_.exponent, parameters_.pressure, parameters_.ambient_pressure,
           parameters_.temperature) {
  const Parameters& p = parameters_;
  for (std::size_t i = 0; i < num_bellows(); ++i) {
    const std::size_t bellows = chambers_.size();
    if (i > 0) passages_.push_back({0, bellows, p.line_area});
    chambers_.push_back({.bellows = static_cast<int>(i),
                         .volume = p.volume,
                         .offset = p.volume - p.effective_area.integral(p.design_height)});
    if (p.auxiliary_volume == 0.0) continue;
    passages_.push_back({bellows, chambers_.size(), p.auxiliary_area});
    chambers_.push_back({.volume = p.auxiliary_volume});
  }
  double total = 0.0;
  for (const Chamber& chamber : chambers_) total += chamber.volume;
  mass_ = total * gas_.ambient_density() * gas_.density_at(p.pressure);
  // ½z² is about the energy of the imbalance.
  const double modulus = p.multiplicity * p.exponent * p.pressure;
  for (std::size_t i = 1; i < chambers_.size(); ++i)
    state_factors_.push_back(std::sqrt(modulus * chambers_[i].volume));
  if (p.levelling) {
    state_factors_.push_back(std::sqrt(modulus * total));
    state_factors_.push_back(p.effective_area.value(p.design_height) * std::sqrt(modulus / p.volume));
    const Levelling& valve = *p.levelling;
    opening_ = PiecewisePolynomial::through_points(
        std::array{-valve.full_opening, -valve.dead_band, valve.dead_band, valve.full_opening},
        std::array{-1.0, 0.0, 0.0, 1.0});
    opening_.continue_straight(valve.full_opening, 0.0, false);
    opening_.continue_straight(-valve.full_opening, 0.0, true);
  }
  add_channels();
}

std::vector<int> AirSpring::markers() const {
  return {parameters_.markers.begin(), parameters_.markers.begin() + 2 * static_cast<int>(num_bellows())};
}

AirSpring::Motion AirSpring::calc_motion(const Instant& instant, std::size_t bellows) const {
  const MarkerState& a = instant.markers[static_cast<std::size_t>(parameters_.markers[2 * bellows])];
  const MarkerState& b = instant.markers[static_cast<std::size_t>(parameters_.markers[2 * bellows + 1])];
  const Eigen::Vector2d span = b.r - a.r;
  Motion motion;
  motion.height = span.norm();
  if (motion.height > 0.0) motion.direction = span / motion.height;
  motion.rate = motion.direction.dot(b.v - a.v);
  return motion;
}

double AirSpring::calc_followed(const Instant& instant) const {
  return instant.states.back() / state_factors_.back();
}

AirSpring::Gas AirSpring::calc_gas(const Instant& instant, std::span<const int> branches) const {
  const PiecewisePolynomial& area = parameters_.effective_area;
  const std::size_t n = chambers_.size();
  Gas gas;
  for (std::size_t i = 0; i < num_bellows(); ++i) {
    gas.motion[i] = calc_motion(instant, i);
    gas.area[i] = area.value(gas.motion[i].height);
  }
  gas.total_mass = mass_;
  if (parameters_.levelling) gas.total_mass *= std::exp(instant.states[n - 1] / state_factors_[n - 1]);
  double weighed = 0.0;  // Σ V_i ρ_i/ρ_0
  for (std::size_t i = 0; i < n; ++i) {
    gas.volume[i] = chambers_[i].volume;
    if (chambers_[i].bellows >= 0) {
      const Motion& motion = gas.motion[static_cast<std::size_t>(chambers_[i].bellows)];
      gas.volume[i] = chambers_[i].offset + area.integral(motion.height);
      // A bellows that is squeezed to nothing has no pressure; the step that comes there is refused.
      if (!(gas.volume[i] > 0.0)) gas.volume[i] = std::numeric_limits<double>::quiet_NaN();
    }
    gas.x[i] = i == 0 ? 1.0 : std::exp(instant.states[i - 1] / state_factors_[i - 1]);
    weighed += gas.volume[i] * gas.x[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    gas.mass[i] = gas.total_mass * gas.volume[i] * gas.x[i] / weighed;
    gas.x[i] *= gas.total_mass / (weighed * gas_.ambient_density());
  }
  for (std::size_t k = 0; k < passages_.size(); ++k) {
    const Passage& passage = passages_[k];
    gas.flow[k] = gas_.mass_flow(passage.area, gas.x[passage.from], gas.x[passage.to]);
    gas.inflow[passage.from] -= gas.flow[k];
    gas.inflow[passage.to] += gas.flow[k];
  }
  if (parameters_.levelling) {
    const Levelling& valve = *parameters_.levelling;
    gas.opening = opening_.value_in_piece(branches[0], calc_followed(instant));
    const double open = std::abs(gas.opening) * valve.area;
    gas.valve_flow = gas.opening > 0.0
                         ? gas_.mass_flow(open, gas_.density_at(valve.supply_pressure), gas.x[0])
                         : -gas_.mass_flow(open, gas.x[0], 1.0);
    gas.inflow[0] += gas.valve_flow;
  }
  return gas;
}

// The gas gives its own chamber what it brings in: p dV does the work on the markers, and mass that passes
// from one pressure to another loses the difference of the enthalpies.
Power AirSpring::add_wrenches(const Instant& instant, std::span<const int> branches,
                              std::span<Wrench> wrenches) const {
  const Gas gas = calc_gas(instant, branches);
  for (std::size_t i = 0; i < chambers_.size(); ++i) {
    if (chambers_[i].bellows < 0) continue;
    const auto bellows = static_cast<std::size_t>(chambers_[i].bellows);
    const double pressure = gas_.pressure(gas.x[i]) - parameters_.ambient_pressure;
    const Eigen::Vector2d on_b =
        parameters_.multiplicity * pressure * gas.area[bellows] * gas.motion[bellows].direction;
    wrenches[static_cast<std::size_t>(parameters_.markers[2 * bellows])].force -= on_b;
    wrenches[static_cast<std::size_t>(parameters_.markers[2 * bellows + 1])].force += on_b;
  }
  Power power;
  for (std::size_t k = 0; k < passages_.size(); ++k) {
    power.dissipated +=
        gas.flow[k] * (gas_.enthalpy(gas.x[passages_[k].from]) - gas_.enthalpy(gas.x[passages_[k].to]));
  }
  const double by_valve = gas.valve_flow * gas_.enthalpy(gas.x[0]);
  (by_valve > 0.0 ? power.input : power.dissipated) += std::abs(by_valve);
  power.dissipated *= parameters_.multiplicity;
  power.input *= parameters_.multiplicity;
  return power;
}

double AirSpring::calc_stored_energy(const Instant& instant, std::span<const int> branches) const {
  const Gas gas = calc_gas(instant, branches);
  double sum = 0.0;
  for (std::size_t i = 0; i < chambers_.size(); ++i) sum += gas.mass[i] * gas_.energy(gas.x[i]);
  return parameters_.multiplicity * sum;
}

std::vector<InternalState> AirSpring::internal_states() const {
  std::vector<InternalState> states;
  const auto add = [&](const char* state) {
    states.push_back({.name = state, .size = kNaturalLogarithm * state_factors_[states.size()]});
  };
  for (std::size_t i = 1; i < chambers_.size(); ++i) {
    const bool is_auxiliary = chambers_[i].bellows < 0;
    add(!is_auxiliary ? "partner" : chambers_[i - 1].bellows == 0 ? "auxiliary" : "partner_auxiliary");
  }
  if (parameters_.levelling) {
    add("mass");
    // Differences of the linearisation stay in the dead band.
    states.push_back({.name = "valve", .size = state_factors_.back() * parameters_.levelling->dead_band});
  }
  return states;
}

void AirSpring::calc_state_rates(const Instant& instant, std::span<const int> branches,
                                 std::span<double> rates) const {
  const Gas gas = calc_gas(instant, branches);
  const std::size_t n = chambers_.size();
  const auto log_rate = [&](std::size_t i) {  // of the density
    const int bellows = chambers_[i].bellows;
    double rate = gas.inflow[i] / gas.mass[i];
    if (bellows >= 0) {
      const auto b = static_cast<std::size_t>(bellows);
      rate -= gas.area[b] * gas.motion[b].rate / gas.volume[i];
    }
    return rate;
  };
  const double first = log_rate(0);
  for (std::size_t i = 1; i < n; ++i) rates[i - 1] = state_factors_[i - 1] * (log_rate(i) - first);
  if (!parameters_.levelling) return;
  rates[n - 1] = state_factors_[n - 1] * gas.valve_flow / gas.total_mass;
  const double deflection = parameters_.design_height - gas.motion[0].height;
  rates[n] = (state_factors_[n] * deflection - instant.states[n]) / parameters_.levelling->delay;
}

// Each passage has the linear flow of (forces, eq. 30).
RandomLaws AirSpring::linearise_for_random_motion(const Instant& at_rest, std::span<const int> branches,
                                                  std::span<const double> rms) const {
  if (passages_.empty()) return {};
  const Gas gas = calc_gas(at_rest, branches);
  const auto n = static_cast<Eigen::Index>(state_factors_.size());
  // Rates of the logarithms of densities by the logarithms of the ratios to the first.
  const auto num_chambers = static_cast<Eigen::Index>(chambers_.size());
  Eigen::MatrixXd by_ratio = Eigen::MatrixXd::Zero(num_chambers, num_chambers);
  for (const Passage& passage : passages_) {
    const double pressure = gas_.pressure(gas.x[passage.from]);
    const double sigma =
        rms.empty() ? kUsualImbalance
                    : std::max(rms[passage.channel] / (parameters_.exponent * pressure), kLeastImbalance);
    const double gain = gas_.calc_mean_gain(passage.area, gas.x[passage.from], sigma);
    const auto from = static_cast<Eigen::Index>(passage.from), to = static_cast<Eigen::Index>(passage.to);
    for (const auto& [chamber, sign] : {std::pair{from, -1.0}, std::pair{to, 1.0}}) {
      const double share = sign * gain / gas.mass[static_cast<std::size_t>(chamber)];
      by_ratio(chamber, from) += share;
      by_ratio(chamber, to) -= share;
    }
  }
  StateLinearisation law{.gain = Eigen::VectorXd::Ones(n), .decay = Eigen::MatrixXd::Zero(n, n)};
  for (Eigen::Index i = 1; i < num_chambers; ++i) {
    for (Eigen::Index j = 1; j < num_chambers; ++j) {
      law.decay(i - 1, j - 1) = -state_factors_[static_cast<std::size_t>(i - 1)] *
                                (by_ratio(i, j) - by_ratio(0, j)) /
                                state_factors_[static_cast<std::size_t>(j - 1)];
    }
  }
  if (parameters_.levelling) law.decay(n - 1, n - 1) = 1.0 / parameters_.levelling->delay;
  return {.states = std::move(law)};
}

void AirSpring::choose_branches(const Instant& instant, std::span<int> branches) const {
  if (parameters_.levelling)
    branches[0] = opening_.choose_piece(branches[0], calc_followed(instant), kValveDeadBand);
}

int AirSpring::num_switches() const {
  return parameters_.levelling ? opening_.num_switches() : 0;
}

void AirSpring::calc_switches(const Instant& instant, std::span<const int> branches,
                              std::span<double> values) const {
  if (parameters_.levelling)
    opening_.calc_piece_switches(branches[0], calc_followed(instant), kValveDeadBand, values);
}

ElementDescription AirSpring::describe() const {
  const Parameters& p = parameters_;
  ElementDescription description{.points = {"a", "b"},
                                 .parameters = {{"multiplicity", p.multiplicity, "1"},
                                                {"design_height", p.design_height, "m"},
                                                {"volume", p.volume, "m^3"},
                                                {"effective_area", p.effective_area, "m^2", "m"},
                                                {"gauge_pressure", p.pressure - p.ambient_pressure, "Pa"},
                                                {"exponent", p.exponent, "1"},
                                                {"ambient_pressure", p.ambient_pressure, "Pa"},
                                                {"temperature", p.temperature, "K"}},
                                 .drawing = Drawing::kSpring};
  const auto add = [&](const char* parameter, double value, const char* unit) {
    description.parameters.push_back({parameter, value, unit});
  };
  if (p.auxiliary_volume > 0.0) {
    add("auxiliary_volume", p.auxiliary_volume, "m^3");
    add("auxiliary_orifice", p.auxiliary_area, "m^2");
  }
  if (p.is_coupled) {
    description.points = {"a", "b", "partner_a", "partner_b"};
    add("line", p.line_area, "m^2");
  }
  if (!p.levelling) return description;
  add("levelling_dead_band", p.levelling->dead_band, "m");
  add("levelling_full_opening", p.levelling->full_opening, "m");
  add("levelling_delay", p.levelling->delay, "s");
  add("levelling_supply_gauge_pressure", p.levelling->supply_pressure - p.ambient_pressure, "Pa");
  add("levelling_orifice", p.levelling->area, "m^2");
  return description;
}

void AirSpring::add_channels() {
  const auto add = [this](std::initializer_list<Channel> more) { channels_.insert(channels_.end(), more); };
  const bool has_auxiliary = parameters_.auxiliary_volume > 0.0;
  std::size_t passage = 0;
  const auto add_difference = [&](const char* channel) {
    passages_[passage++].channel = channels_.size();
    add({{channel, "Pa", ChannelRole::kPressure}});
  };
  add({{"length", "m", ChannelRole::kExtent},
       {"deflection", "m", ChannelRole::kDeflection},
       {"rate", "m/s", ChannelRole::kRate},
       {"force", "N", ChannelRole::kForce},
       {"gauge_pressure", "Pa", ChannelRole::kPressure}});
  if (has_auxiliary) add_difference("pressure_difference");
  if (parameters_.is_coupled) {
    add({{"partner_length", "m", ChannelRole::kExtent},
         {"partner_deflection", "m", ChannelRole::kDeflection},
         {"partner_rate", "m/s", ChannelRole::kRate},
         {"partner_force", "N", ChannelRole::kForce},
         {"partner_gauge_pressure", "Pa", ChannelRole::kPressure}});
    add_difference("line_pressure_difference");
    if (has_auxiliary) add_difference("partner_pressure_difference");
  }
  add({{"mass", "kg", ChannelRole::kMass}});
  if (parameters_.levelling) add({{"valve_flow", "kg/s", ChannelRole::kMassFlow}});
}

void AirSpring::calc_channels(const Instant& instant, std::span<const int> branches,
                              std::span<double> values) const {
  const Gas gas = calc_gas(instant, branches);
  const auto pressure = [&](std::size_t chamber) { return gas_.pressure(gas.x[chamber]); };
  std::size_t next = 0, passage = 0;
  const auto put = [&](double value) { values[next++] = value; };
  const auto put_difference = [&] {
    put(pressure(passages_[passage].from) - pressure(passages_[passage].to));
    ++passage;
  };
  for (std::size_t i = 0; i < chambers_.size(); ++i) {
    if (chambers_[i].bellows < 0) continue;
    const auto bellows = static_cast<std::size_t>(chambers_[i].bellows);
    const double gauge = pressure(i) - parameters_.ambient_pressure;
    put(gas.motion[bellows].height);
    put(parameters_.design_height - gas.motion[bellows].height);
    put(-gas.motion[bellows].rate);
    put(parameters_.multiplicity * gauge * gas.area[bellows]);
    put(gauge);
    if (bellows > 0) put_difference();
    if (parameters_.auxiliary_volume > 0.0) put_difference();
  }
  put(parameters_.multiplicity * gas.total_mass);
  if (parameters_.levelling) put(parameters_.multiplicity * gas.valve_flow);
}

}  // namespace sprung::dynamics
