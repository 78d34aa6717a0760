#include "dynamics/program/response_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "dynamics/functions/mean_slope.h"
#include "dynamics/output/resting_forces.h"
#include "dynamics/preparation/start_state.h"

namespace sprung::dynamics {

namespace {

constexpr double kReach = 3.0;  // r.m.s. values: a normal variable goes so far in a thousandth of the time
constexpr double kBent = 0.05;  // change of a slope, of that at rest
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
  const auto channels = force.channels();
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [](const Channel& channel) { return channel.role == ChannelRole::kForce; });
  const auto place = static_cast<std::size_t>(found - channels.begin());
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

bool can_lift(const PreparedRun& prepared, std::size_t force) {
  const auto* tyre = std::get_if<TyreDescription>(&prepared.vehicle.forces[force].parameters);
  return tyre != nullptr && tyre->parameters.one_sided;
}

}  // namespace

std::vector<RunWarning> list_response_warnings(const PreparedRun& prepared, const LinearVehicle& vehicle,
                                               const ResponseResult& result) {
  Warnings warnings;
  warn_at_rest(prepared, vehicle, warnings);
  if (!result.has_road()) return warnings.take();
  const Model& model = vehicle.model();
  const RestingForces at_equilibrium(model, prepared.equilibrium->q);
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const std::vector<double> at_rest = at_equilibrium.calc_channels(f);
    if (can_lift(prepared, f)) warn_of_lifting(*model.forces[f], at_rest, result, warnings);
    warn_of_bends(*model.forces[f], at_rest, result, warnings);
  }
  return warnings.take();
}

}  // namespace sprung::dynamics
