#include "dynamics/response/linear_vehicle.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace sprung::dynamics {

LinearVehicle::LinearVehicle(const Model& model, const Eigen::VectorXd& q)
    : q_(q), equations_(model), system_(linearise(equations_, 0.0, q)) {
  const Eigen::VectorXd q_i = independent_positions();
  kinks_ = find_kinks(equations_, 0.0, q_i);
  calc_static_force(equations_, 0.0, q_i);
  equations_.update_all_markers();
  branches_ = equations_.terms().find_branches();

  channel_rows_.push_back(0);
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    channel_rows_.push_back(channel_rows_.back() + static_cast<int>(force.channels().size()));
    const std::optional<RoadPlace> place =
        force.find_road_place(equations_.terms().instant_of(f), model.branches_of(f, branches_));
    if (!place) continue;
    inputs_.push_back({.name = force.name,
                       .force = static_cast<int>(f),
                       .distance = place->distance,
                       .is_pressed = place->is_pressed,
                       .can_lift = place->can_lift});
  }
}

std::vector<std::vector<double>> list_rate_slopes(const std::vector<RandomLaws>& laws) {
  std::vector<std::vector<double>> slopes;
  for (const RandomLaws& law : laws) slopes.push_back(law.rate_slopes);
  return slopes;
}

// States are the last independent coordinates.
void LinearVehicle::set_random_laws(std::vector<RandomLaws> laws) {
  laws_ = std::move(laws);
  equations_.set_rate_slopes(list_rate_slopes(laws_));
  system_.damping = calc_reduced_damping(equations_);
  calc_static_force(equations_, 0.0, independent_positions());
  equations_.update_all_markers();
  const Eigen::Index first_state = system_.mass.rows() - model().num_states();
  for (std::size_t f = 0; f < laws_.size(); ++f) {
    if (!laws_[f].states) continue;
    const StateLinearisation& law = *laws_[f].states;
    const Eigen::Index n = law.gain.size(), first = first_state + model().force_states[f];
    system_.damping.middleRows(first, n) = law.gain.asDiagonal() * system_.damping.middleRows(first, n);
    system_.damping.block(first, first, n, n) = law.decay;
  }
  solver_.reset();
}

const FrequencySolver& LinearVehicle::solver() const {
  if (!solver_) solver_.emplace(system_.mass, system_.damping, system_.stiffness, system_.stiffness_rounding);
  return *solver_;
}

Eigen::VectorXd LinearVehicle::independent_positions() const {
  return q_(system_.partition.independent);
}

RoadAction LinearVehicle::calc_road_action(const RoadWave& wave) const {
  const auto num_inputs = static_cast<Eigen::Index>(inputs_.size());
  RoadAction action{.forces = Eigen::MatrixXcd::Zero(model().num_coordinates, num_inputs),
                    .channels = Eigen::MatrixXcd::Zero(channel_rows_.back(), num_inputs)};
  std::vector<WrenchGain> wrenches(model().markers.size());
  Eigen::VectorXcd channels;
  for (Eigen::Index i = 0; i < num_inputs; ++i) {
    const auto f = static_cast<std::size_t>(inputs_[static_cast<std::size_t>(i)].force);
    calc_road_wrenches(static_cast<std::size_t>(i), wave, wrenches, channels);
    action.channels.col(i).segment(channel_rows_[f], channels.size()) = channels;
    for (const int marker : model().forces[f]->markers()) {
      const WrenchGain& wrench = wrenches[static_cast<std::size_t>(marker)];
      const Eigen::Vector3cd gain(wrench.force.x(), wrench.force.y(), wrench.torque);
      action.forces.col(i) += calc_marker_jacobian(equations_.terms(), marker).transpose() * gain;
    }
  }
  return action;
}

Eigen::VectorXd LinearVehicle::calc_channels() const {
  Eigen::VectorXd values(channel_rows_.back());
  for (std::size_t f = 0; f < model().forces.size(); ++f) {
    const ForceElement& force = *model().forces[f];
    force.calc_channels(equations_.terms().instant_of(f), model().branches_of(f, branches_),
                        std::span(values.data() + channel_rows_[f], force.channels().size()));
  }
  return values;
}

void LinearVehicle::calc_road_wrenches(std::size_t input, const RoadWave& wave,
                                       std::span<WrenchGain> wrenches, Eigen::VectorXcd& channels) const {
  const auto f = static_cast<std::size_t>(inputs_[input].force);
  const ForceElement& force = *model().forces[f];
  for (const int marker : force.markers()) wrenches[static_cast<std::size_t>(marker)] = {};
  channels.setZero(static_cast<Eigen::Index>(force.channels().size()));
  if (!inputs_[input].is_pressed) return;
  force.add_road_response(equations_.terms().instant_of(f), model().branches_of(f, branches_), wave, wrenches,
                          {channels.data(), static_cast<std::size_t>(channels.size())});
}

Eigen::MatrixXcd LinearVehicle::calc_motion(double omega, const RoadAction& action) const {
  return solver().solve(omega, system_.directions.transpose() * action.forces);
}

Eigen::VectorXcd LinearVehicle::calc_delays(const RoadWave& wave) const {
  double foremost = -std::numeric_limits<double>::infinity();
  for (const RoadInput& input : inputs_) foremost = std::max(foremost, input.distance);
  Eigen::VectorXcd delays(static_cast<Eigen::Index>(inputs_.size()));
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    delays[static_cast<Eigen::Index>(i)] =
        std::polar(1.0, wave.wavenumber * (inputs_[i].distance - foremost));
  }
  return delays;
}

}  // namespace sprung::dynamics
