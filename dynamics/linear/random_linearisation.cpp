#include "dynamics/linear/random_linearisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxIterations = 200;
constexpr double kSettled = 1e-6;    // relative change of the root mean squares
constexpr double kLeastRms = 1e-12;  // below it, a root mean square counts as none

std::optional<StateLinearisation> linearise_states(const LinearVehicle& vehicle, std::size_t force,
                                                   std::span<const double> rms) {
  return vehicle.model().forces[force]->linearise_states(
      vehicle.equations().terms().instant_of(force), vehicle.model().branches_of(force, vehicle.branches()),
      rms);
}

// An element, and the root mean squares of its channels.
struct MovingElement {
  std::size_t force = 0;
  std::vector<double> rms = {};

  double deflection(const Model& model) const {
    const std::span<const Channel> channels = model.forces[force]->channels();
    const auto found = std::find_if(channels.begin(), channels.end(), [](const Channel& channel) {
      return channel.role == ChannelRole::kDeflection;
    });
    return found == channels.end() ? 0.0 : rms[static_cast<std::size_t>(found - channels.begin())];
  }

  // Goes half of the way to other values, in the logarithm: friction that damps less lets the motion grow,
  // and so damps more. @return the largest relative change that was left
  double approach(const Eigen::VectorXd& found) {
    const bool is_first = rms.empty();
    if (is_first) rms.resize(static_cast<std::size_t>(found.size()));
    double change = is_first ? 1.0 : 0.0;
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      double& one = rms[static_cast<std::size_t>(i)];
      const double next = std::max(found[i], kLeastRms);
      if (!is_first) change = std::max(change, std::abs(std::log(next / one)));
      one = is_first ? next : std::sqrt(one * next);
    }
    return change;
  }
};

}  // namespace

bool needs_random_linearisation(const LinearVehicle& vehicle, std::size_t force) {
  return linearise_states(vehicle, force, {}).has_value();
}

std::vector<RandomLinearisation> linearise_for_random_motion(LinearVehicle& vehicle, const RoadSpectrum& road,
                                                             double speed, const FrequencyRange& range) {
  const Model& model = vehicle.model();
  std::vector<MovingElement> elements;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const std::optional<StateLinearisation> law = linearise_states(vehicle, f, {});
    if (!law) continue;
    vehicle.set_state_law(f, *law);
    elements.push_back({.force = f});
  }
  if (elements.empty()) return {};
  const LinearOutputs all = make_force_outputs(vehicle);
  std::vector<int> rows;
  for (const MovingElement& one : elements) {
    for (int i = 0; i < all.size(); ++i) {
      if (all.subjects[static_cast<std::size_t>(i)].object == static_cast<int>(one.force)) rows.push_back(i);
    }
  }
  const LinearOutputs motion = all.pick(rows);
  for (int iteration = 0;; ++iteration) {
    const Eigen::VectorXd rms = calc_root_mean_squares(vehicle, motion, road, speed, range);
    Eigen::VectorXd of_channels = Eigen::VectorXd::Zero(vehicle.channel_rows().back());
    for (Eigen::Index i = 0; i < rms.size(); ++i)
      of_channels[motion.channels[static_cast<std::size_t>(i)]] = rms[i];
    double change = 0.0;
    for (MovingElement& one : elements) {
      const auto count = static_cast<Eigen::Index>(model.forces[one.force]->channels().size());
      change = std::max(change, one.approach(of_channels.segment(vehicle.channel_rows()[one.force], count)));
      vehicle.set_state_law(one.force, *linearise_states(vehicle, one.force, one.rms));
    }
    if (change <= kSettled) break;
    if (iteration == kMaxIterations) {
      throw support::NumericalError(fmt::format(
          "response: the linear law of the states of '{}' does not settle; run the vehicle in time",
          model.forces[elements.front().force]->name));
    }
  }
  std::vector<RandomLinearisation> found;
  for (const MovingElement& one : elements)
    found.push_back({model.forces[one.force]->name, one.deflection(model)});
  return found;
}

}  // namespace sprung::dynamics
