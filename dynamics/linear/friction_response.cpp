#include "dynamics/linear/friction_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

namespace {

constexpr int kMaxIterations = 200;
constexpr double kSettled = 1e-6;  // relative change of the root mean squares
// The motion that the iteration starts from.
constexpr double kFirstDeflection = 0.01;                                 // m
constexpr double kFirstRate = kFirstDeflection * 4.0 * std::numbers::pi;  // m/s, at 2 Hz
constexpr double kLeastDeflection = 1e-9;                                 // m

// An element, and the root mean squares of its motion.
struct Friction {
  int force = 0;
  int deflection_row = 0, rate_row = 0;  // of the outputs
  double deflection = kFirstDeflection, rate = kFirstRate;
};

int find_row(const LinearOutputs& outputs, int force, ChannelRole role) {
  const auto found =
      std::find_if(outputs.subjects.begin(), outputs.subjects.end(), [&](const OutputSubject& subject) {
        return subject.kind == OutputSubject::Kind::kChannel && subject.object == force &&
               subject.role == role;
      });
  return static_cast<int>(found - outputs.subjects.begin());
}

}  // namespace

std::vector<LinearisedFriction> linearise_friction_by_response(LinearVehicle& vehicle,
                                                               const RoadSpectrum& road, double speed,
                                                               const FrequencyRange& range) {
  const Model& model = vehicle.model();
  std::vector<Friction> frictions;
  const auto apply = [&](const Friction& one) {
    const ForceElement& force = *model.forces[static_cast<std::size_t>(one.force)];
    vehicle.set_state_law(one.force, *force.linearise_state(one.deflection, one.rate));
  };
  const LinearOutputs all = make_force_outputs(vehicle);
  std::vector<int> rows;
  for (int f = 0; f < static_cast<int>(model.forces.size()); ++f) {
    if (!model.forces[static_cast<std::size_t>(f)]->linearise_state(kFirstDeflection, kFirstRate)) continue;
    const auto next = static_cast<int>(rows.size());
    rows.push_back(find_row(all, f, ChannelRole::kDeflection));
    rows.push_back(find_row(all, f, ChannelRole::kRate));
    frictions.push_back({.force = f, .deflection_row = next, .rate_row = next + 1});
    apply(frictions.back());
  }
  if (frictions.empty()) return {};
  const LinearOutputs motion = all.pick(rows);
  for (int iteration = 0;; ++iteration) {
    const Eigen::VectorXd rms = calc_root_mean_squares(vehicle, motion, road, speed, range);
    double change = 0.0;
    for (Friction& one : frictions) {
      // Half of each step, in the logarithm: friction that damps less lets the motion grow, and so damps
      // more.
      const double deflection = std::max(rms[one.deflection_row], kLeastDeflection);
      const double rate = std::max(rms[one.rate_row], kLeastDeflection);
      change = std::max(
          {change, std::abs(std::log(deflection / one.deflection)), std::abs(std::log(rate / one.rate))});
      one.deflection = std::sqrt(one.deflection * deflection);
      one.rate = std::sqrt(one.rate * rate);
      apply(one);
    }
    if (change <= kSettled) break;
    if (iteration == kMaxIterations) {
      throw support::NumericalError(fmt::format(
          "response: the linear law of the friction of '{}' does not settle; run the vehicle in time",
          model.forces[static_cast<std::size_t>(frictions.front().force)]->name));
    }
  }
  std::vector<LinearisedFriction> found;
  for (const Friction& one : frictions)
    found.push_back({model.forces[static_cast<std::size_t>(one.force)]->name, one.deflection});
  return found;
}

}  // namespace sprung::dynamics
