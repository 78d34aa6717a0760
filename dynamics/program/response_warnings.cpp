#include "dynamics/program/response_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "dynamics/functions/mean_slope.h"
#include "dynamics/output/response_report.h"
#include "dynamics/output/resting_forces.h"
#include "dynamics/preparation/full_model.h"
#include "dynamics/preparation/start_state.h"
#include "dynamics/response/held_modes_effect.h"

namespace sprung::dynamics {

namespace {

constexpr double kReach = 3.0;  // r.m.s. values: a normal variable goes so far in a thousandth of the time
constexpr double kBent = 0.05;  // change of a slope, of that at rest
constexpr double kTooMuchLeftOut = 0.05;  // change of an output by the modes left out, as for a run
constexpr double kRestReach = 1e-6;       // m or rad, r.m.s.: within it a law has its slope at rest

class Warnings {
 public:
  void add(const std::string& of, std::string text) {
    list_.push_back({std::string(kResponse), {of}, std::move(text)});
  }
  std::vector<RunWarning> take() { return std::move(list_); }

 private:
  std::vector<RunWarning> list_;
};

void warn_at_rest(const PreparedRun& prepared, const LinearVehicle& vehicle, Warnings& warnings) {
  for (const RoadInput& input : vehicle.inputs()) {
    if (input.is_pressed) continue;
    warnings.add(
        input.name,
        fmt::format("'{}' is off the ground in static equilibrium: the road does not act on it", input.name));
  }
  for (const Kink& kink : vehicle.kinks()) {
    if (kink.in_position) warnings.add(kink.element, kink.describe());
  }
  for (const WheelSpeed& wheel : find_wheels_of_other_speed(prepared)) {
    warnings.add(
        wheel.name,
        fmt::format("'{}' rolls at {:.6g} m/s at the start of a run; the road passes at 'speed', {:g} m/s",
                    wheel.name, wheel.speed, prepared.run.speed));
  }
}

// The r.m.s. value of a channel of a force element.
double find_rms(const ResponseResult& result, const ForceElement& force, std::size_t channel) {
  const std::string name = fmt::format("forces/{}/{}", force.name, force.channels()[channel].name);
  const auto found = std::find(result.names.begin(), result.names.end(), name);
  return result.rms[found - result.names.begin()];
}

// Wheels that the random road would lift, which a linear vehicle cannot know.
void warn_of_lifting(const ForceElement& force, const std::vector<double>& at_rest,
                     const ResponseResult& result, Warnings& warnings) {
  const std::size_t place = force.find_channel(ChannelRole::kForce).value();
  const double rms = find_rms(result, force, place);
  if (kReach * rms <= at_rest[place]) return;
  warnings.add(force.name,
               fmt::format("'{}' leaves the ground now and then, which a linear response does not "
                           "contain: its force varies by {:.4g} N r.m.s. about {:.4g} N at rest",
                           force.name, rms, at_rest[place]));
}

// Stops that the random road would reach, and springs whose stiffness over their motion is not that at rest.
void warn_of_bends(const ForceElement& force, const std::vector<double>& at_rest,
                   const ResponseResult& result, Warnings& warnings) {
  for (const DeflectionLaw& one : force.deflection_laws()) {
    const Channel& channel = force.channels()[one.channel];
    const double rms = find_rms(result, force, one.channel), rest = at_rest[one.channel];
    bool reaches_stop = false;
    const auto warn_of_stop = [&](const std::optional<double>& stop, const char* which) {
      if (!stop || !(std::abs(*stop - rest) < kReach * rms)) return;
      reaches_stop = true;
      warnings.add(
          force.name,
          fmt::format("'{}' reaches its {}stop now and then, which a linear response does not contain: "
                      "its {} varies by {:.3g} {} r.m.s. about {:.4g} {} at rest, and the stop begins "
                      "at {:.4g} {}",
                      force.name, which, channel.name, rms, channel.unit, rest, channel.unit, *stop,
                      channel.unit));
    };
    warn_of_stop(one.compression_stop, one.law == nullptr ? "" : "compression ");
    warn_of_stop(one.rebound_stop, "rebound ");
    if (reaches_stop || one.law == nullptr || !(rms > kRestReach)) continue;
    const double slope = calc_mean_slope(*one.law, kRestReach, rest),
                 mean = calc_mean_slope(*one.law, rms, rest);
    if (std::abs(mean - slope) <= kBent * std::abs(slope)) continue;
    const bool turns = channel.unit == "rad";
    warnings.add(
        force.name,
        fmt::format("'{}' has another stiffness in its motion than the one at rest, which a linear "
                    "response takes: {:.4g} {} in the mean over a {} of {:.3g} {} r.m.s., and {:.4g} at "
                    "rest",
                    force.name, mean, turns ? "N·m/rad" : "N/m", channel.name, rms, channel.unit, slope));
  }
}

// Modes left out whose effect on an output of the table is large.
void warn_of_missing_modes(const PreparedRun& prepared, const LinearVehicle& vehicle, const Run& run,
                           Warnings& warnings) {
  const std::optional<FullVehicle> full = make_full_vehicle(prepared);
  if (!full) return;
  LinearVehicle linear(full->model, full->q);
  if (!vehicle.random_laws().empty()) linear.set_random_laws(vehicle.random_laws());
  LinearOutputs outputs = make_force_outputs(linear);
  for (const std::string& point : resolve_response_points(run, prepared.vehicle))
    outputs.append(make_point_outputs(linear, full->model.find_marker(point)));
  std::vector<int> rows;
  for (int i = 0; i < outputs.size(); ++i)
    if (is_main_output(outputs.subjects[static_cast<std::size_t>(i)])) rows.push_back(i);
  outputs = outputs.pick(rows);
  const RoadSpectrum* road = run.response.road ? &*run.response.road : nullptr;
  const Eigen::VectorXd change = calc_effect_of_holding(linear, outputs, full->left_out, road, run.speed,
                                                        {run.response.from, run.response.to});
  Eigen::Index worst = 0;
  const double largest = change.cwiseAbs().maxCoeff(&worst);
  if (largest <= kTooMuchLeftOut) return;
  const std::string& name = outputs.names[static_cast<std::size_t>(worst)];
  warnings.add(
      name,
      fmt::format("modes are missing: without those left out {} of {} is {:.3g} % too {}, and "
                  "{} of {} outputs in the table differ by more than {:g} %; {}; take more modes",
                  road ? "the r.m.s. value" : "the transfer function", name, 100.0 * largest,
                  change[worst] > 0.0 ? "large" : "small", (change.array().abs() > kTooMuchLeftOut).count(),
                  change.size(), 100.0 * kTooMuchLeftOut, fmt::join(full->incomplete, ", ")));
}

}  // namespace

std::vector<RunWarning> list_response_warnings(const PreparedRun& prepared, const LinearVehicle& vehicle,
                                               const ResponseResult& result) {
  Warnings warnings;
  warn_at_rest(prepared, vehicle, warnings);
  warn_of_missing_modes(prepared, vehicle, prepared.run, warnings);
  if (!result.has_road()) return warnings.take();
  if (result.road_rms == 0.0) {
    const ResponseRequest& response = prepared.run.response;
    warnings.add("response.road", fmt::format("at {:g} m/s no wave of the road in response.road lies between "
                                              "{:g} and {:g} Hz: all r.m.s. values are 0",
                                              prepared.run.speed, response.from, response.to));
    return warnings.take();
  }
  const Model& model = vehicle.model();
  const RestingForces at_equilibrium(model, prepared.equilibrium->q);
  for (const RoadInput& input : vehicle.inputs()) {
    const auto f = static_cast<std::size_t>(input.force);
    if (input.can_lift) warn_of_lifting(*model.forces[f], at_equilibrium.calc_channels(f), result, warnings);
  }
  for (std::size_t f = 0; f < model.forces.size(); ++f)
    warn_of_bends(*model.forces[f], at_equilibrium.calc_channels(f), result, warnings);
  return warnings.take();
}

}  // namespace sprung::dynamics
