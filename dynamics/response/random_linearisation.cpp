#include "dynamics/response/random_linearisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxIterations = 200;
constexpr double kSettled = 1e-6;    // relative change of the laws
constexpr double kLeastRms = 1e-12;  // below it, a root mean square counts as this

RandomLaws linearise(const LinearVehicle& vehicle, std::size_t force, std::span<const double> rms) {
  return vehicle.model().forces[force]->linearise_for_random_motion(
      vehicle.equations().terms().instant_of(force), vehicle.model().branches_of(force, vehicle.branches()),
      rms);
}

// Largest change of an entry, of the largest entry.
template <typename Values>
double calc_change(const Values& old_values, const Values& new_values) {
  if (new_values.size() == 0) return 0.0;
  const double largest = new_values.cwiseAbs().maxCoeff();
  return largest == 0.0 ? 0.0 : (new_values - old_values).cwiseAbs().maxCoeff() / largest;
}

double calc_change(const RandomLaws& old_laws, const RandomLaws& new_laws) {
  const auto slopes_of = [](const RandomLaws& laws) {
    return Eigen::Map<const Eigen::VectorXd>(laws.rate_slopes.data(),
                                             static_cast<Eigen::Index>(laws.rate_slopes.size()));
  };
  double change = calc_change(Eigen::VectorXd(slopes_of(old_laws)), Eigen::VectorXd(slopes_of(new_laws)));
  if (!new_laws.states) return change;
  change = std::max(change, calc_change(old_laws.states->gain, new_laws.states->gain));
  return std::max(change, calc_change(old_laws.states->decay, new_laws.states->decay));
}

// An element, and the root mean squares of its channels.
struct MovingElement {
  std::size_t force = 0;
  std::vector<double> rms = {};

  // Goes half of the way to other values, in the logarithm: friction that damps less lets the motion grow,
  // and so damps more.
  void approach(const Eigen::VectorXd& found) {
    const bool is_first = rms.empty();
    if (is_first) rms.resize(static_cast<std::size_t>(found.size()));
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      double& one = rms[static_cast<std::size_t>(i)];
      const double next = std::max(found[i], kLeastRms);
      one = is_first ? next : std::sqrt(one * next);
    }
  }

  RandomLinearisation describe(const Model& model, const RandomLaws& laws) const {
    const ForceElement& element = *model.forces[force];
    RandomLinearisation found{.element = element.name, .has_states = laws.states.has_value()};
    const std::span<const Channel> channels = element.channels();
    for (std::size_t c = channels.size(); c-- > 0;)
      if (channels[c].role == ChannelRole::kDeflection) found.rms_deflection = rms[c];
    if (laws.rate_slopes.empty()) return found;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      if (channels[c].role != ChannelRole::kRate) continue;
      found.rms_rates.push_back(rms[c]);
      found.rate_units.push_back(channels[c].unit);
    }
    return found;
  }
};

// The channels of some elements.
LinearOutputs make_motion_outputs(const LinearVehicle& vehicle, const std::vector<MovingElement>& elements) {
  const LinearOutputs all = make_force_outputs(vehicle);
  std::vector<int> rows;
  for (const MovingElement& one : elements) {
    for (int i = 0; i < all.size(); ++i) {
      if (all.subjects[static_cast<std::size_t>(i)].object == static_cast<int>(one.force)) rows.push_back(i);
    }
  }
  return all.pick(rows);
}

}  // namespace

RandomLaws find_random_laws(const LinearVehicle& vehicle, std::size_t force) {
  return linearise(vehicle, force, {});
}

std::vector<RandomLinearisation> linearise_for_random_motion(LinearVehicle& vehicle, const RoadSpectrum& road,
                                                             double speed, const FrequencyRange& range) {
  const Model& model = vehicle.model();
  std::vector<MovingElement> elements;
  std::vector<RandomLaws> laws;
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    laws.push_back(linearise(vehicle, f, {}));
    if (!laws.back().is_empty()) elements.push_back({.force = f});
  }
  if (elements.empty()) return {};
  vehicle.set_random_laws(laws);
  // Motion and states do not depend on the laws of forces, so these outputs serve all laws.
  const LinearOutputs motion = make_motion_outputs(vehicle, elements);
  for (int iteration = 0;; ++iteration) {
    const Eigen::VectorXd rms = calc_root_mean_squares(vehicle, motion, road, speed, range);
    Eigen::VectorXd of_channels = Eigen::VectorXd::Zero(vehicle.channel_rows().back());
    for (Eigen::Index i = 0; i < rms.size(); ++i)
      of_channels[motion.channels[static_cast<std::size_t>(i)]] = rms[i];
    double change = 0.0;
    for (MovingElement& one : elements) {
      const auto count = static_cast<Eigen::Index>(model.forces[one.force]->channels().size());
      one.approach(of_channels.segment(vehicle.channel_rows()[one.force], count));
      RandomLaws next = linearise(vehicle, one.force, one.rms);
      change = std::max(change, calc_change(laws[one.force], next));
      laws[one.force] = std::move(next);
    }
    vehicle.set_random_laws(laws);
    if (change <= kSettled) break;
    if (iteration == kMaxIterations) {
      throw support::NumericalError(
          fmt::format("response: the linear laws of '{}' for random motion do not settle; run the vehicle in "
                      "time",
                      model.forces[elements.front().force]->name));
    }
  }
  std::vector<RandomLinearisation> found;
  for (const MovingElement& one : elements) found.push_back(one.describe(model, laws[one.force]));
  return found;
}

}  // namespace sprung::dynamics
