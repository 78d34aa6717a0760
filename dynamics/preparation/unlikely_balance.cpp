#include "dynamics/preparation/unlikely_balance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "dynamics/output/resting_forces.h"
#include "dynamics/preparation/hanging_bodies.h"
#include "dynamics/preparation/turned_springs.h"
#include "dynamics/system/system_terms.h"
#include "tools/support/errors/input_error.h"

namespace sprung::dynamics {

namespace {

constexpr double kFarTurned = 0.25 * std::numbers::pi;
constexpr double kDeeplyPressed = 0.5;  // of a tyre's radius
constexpr double kFarApart = 10.0;      // of the largest distance of a point from its body's frame
constexpr double kFarSettled = 0.1;     // the same

std::string remark_at(const support::SourceLocation& location, const std::string& text) {
  return fmt::format("{}: in static equilibrium {}", support::format_place(location), text);
}

void check_tyre(const ForceDescription& force, double height, std::vector<std::string>& remarks) {
  const double radius = std::get<TyreDescription>(force.parameters).parameters.radius;
  const double pressed = radius - height;
  if (pressed <= kDeeplyPressed * radius) return;
  const std::string text = fmt::format(
      "'forces.{}' is pressed in by {:.3g} m of its radius of {:.3g} m; stiffnesses are in N/m, not in N/mm",
      force.name, pressed, radius);
  if (pressed > radius) throw support::InputError(force.location, "in static equilibrium " + text);
  remarks.push_back(remark_at(force.location, text));
}

// A suspension that stands on a stop, or hangs in it: springs that bear no load, or a stop that is measured
// from elsewhere.
void check_stops(const ForceDescription& force, const ForceElement& element, std::span<const double> channels,
                 std::vector<std::string>& remarks) {
  const std::optional<std::size_t> channel = element.find_channel(ChannelRole::kDeflection);
  if (!channel) return;
  const double deflection = channels[*channel];
  const std::string_view unit = element.channels()[*channel].unit;
  for (const Parameter& parameter : element.describe().parameters) {
    const bool is_compression = parameter.name == "compression_stop";
    if (!is_compression && parameter.name != "rebound_stop") continue;
    const double beyond = (is_compression ? 1.0 : -1.0) * (deflection - std::get<double>(parameter.value));
    if (!(beyond > 0.0)) continue;
    remarks.push_back(remark_at(
        force.location,
        fmt::format(
            "'forces.{}' is on its {} stop, {:.3g} {} deep: its deflection is {:.4g} {}, and the stop begins "
            "at {:.4g} {}, both from the free length",
            force.name, is_compression ? "compression" : "rebound", beyond, unit, deflection, unit,
            std::get<double>(parameter.value), unit)));
  }
}

void remark_on_hanging_bodies(const Vehicle& vehicle, const Model& model, const RestingForces& at_rest,
                              std::vector<std::string>& remarks) {
  for (const HangingBody& one : find_hanging_bodies(vehicle, model, at_rest)) {
    const ForceDescription& force = vehicle.forces[one.force];
    remarks.push_back(remark_at(
        force.location,
        fmt::format("'forces.{}' pulls with {:.4g} N, and 'bodies.{}' hangs on it: nothing else holds it up; "
                    "is a tyre missing?",
                    force.name, one.pull, vehicle.bodies[static_cast<std::size_t>(one.body)].name)));
  }
}

// A wheel whose centre is drawn under the road.
struct DeepWheel {
  const ForceDescription* force;
  double depth;  // of its centre [m]
};

// The deepest one, if there are any.
std::optional<DeepWheel> find_wheel_under_road(const Vehicle& vehicle, const Model& model,
                                               const Eigen::VectorXd& drawn) {
  SystemTerms terms(model);
  terms.update_positions(0.0, drawn);
  std::optional<DeepWheel> deepest;
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
    if (!vehicle.forces[f].on_road) continue;
    const double depth = -terms.markers()[static_cast<std::size_t>(model.forces[f]->markers().front())].r.y();
    if (depth > (deepest ? deepest->depth : 0.0)) deepest = {&vehicle.forces[f], depth};
  }
  return deepest;
}

std::string describe(const DeepWheel& wheel) {
  return fmt::format("as drawn, the centre of the wheel of 'forces.{}' is {:.4g} m under the road",
                     wheel.force->name, wheel.depth);
}

}  // namespace

std::vector<std::string> list_unlikely_balance(const Vehicle& vehicle, const Model& model,
                                               const Eigen::VectorXd& drawn, const Eigen::VectorXd& found) {
  std::vector<std::string> remarks;
  const RestingForces at_rest(model, found);
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f)
    check_stops(vehicle.forces[f], *model.forces[f], at_rest.calc_channels(f), remarks);
  bool has_tyres = false;
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
    if (!vehicle.forces[f].on_road) continue;
    has_tyres = true;
    const auto center = static_cast<std::size_t>(model.forces[f]->markers().front());
    check_tyre(vehicle.forces[f], at_rest.terms().markers()[center].r.y(), remarks);
  }
  if (std::string remark = remark_on_wheel_under_road(vehicle, model, drawn); !remark.empty())
    remarks.push_back(std::move(remark));
  for (std::size_t b = 0; b < model.bodies.size() && has_tyres; ++b) {
    const Eigen::Index angle = model.bodies[b].first_coordinate + 2, height = angle - 1;
    const double risen = found[height] - drawn[height];
    if (std::abs(risen) > kFarSettled * model.length_scale) {
      remarks.push_back(
          remark_at(vehicle.bodies[b].location,
                    fmt::format("'bodies.{}' is {:.3g} m {} than it is drawn", vehicle.bodies[b].name,
                                std::abs(risen), risen > 0.0 ? "higher" : "lower")));
    }
    const double turned = found[angle] - drawn[angle];
    if (std::abs(turned) <= kFarTurned) continue;
    remarks.push_back(remark_at(vehicle.bodies[b].location,
                                fmt::format("'bodies.{}' is turned by {:.3g}° from where it is drawn",
                                            vehicle.bodies[b].name, turned * 180.0 / std::numbers::pi)));
  }
  if (has_tyres) remark_on_hanging_bodies(vehicle, model, at_rest, remarks);
  for (const std::size_t f : find_turned_springs(vehicle, model, drawn, found)) {
    remarks.push_back(
        remark_at(vehicle.forces[f].location,
                  fmt::format("'forces.{}' points the other way than as drawn; does it carry its load?",
                              vehicle.forces[f].name)));
  }
  return remarks;
}

std::string remark_on_wheel_under_road(const Vehicle& vehicle, const Model& model,
                                       const Eigen::VectorXd& drawn) {
  const std::optional<DeepWheel> deepest = find_wheel_under_road(vehicle, model, drawn);
  if (!deepest) return {};
  return fmt::format("{}: {}", support::format_place(deepest->force->location), describe(*deepest));
}

void reject_wheels_under_road(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& drawn) {
  const std::optional<DeepWheel> deepest = find_wheel_under_road(vehicle, model, drawn);
  if (!deepest) return;
  throw support::InputError(deepest->force->location, "no static equilibrium: " + describe(*deepest) +
                                                          "; check the positions of the bodies");
}

std::string describe_idle_bodies(const Model& model) {
  std::set<int> acted_on;
  for (const auto& joint : model.joints) {
    for (const int marker : {joint->marker_a, joint->marker_b})
      acted_on.insert(model.markers[static_cast<std::size_t>(marker)].body);
  }
  for (const auto& force : model.forces) {
    for (const int marker : force->markers())
      acted_on.insert(model.markers[static_cast<std::size_t>(marker)].body);
  }
  std::vector<std::string> names;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (!acted_on.contains(static_cast<int>(b))) names.push_back("'bodies." + model.bodies[b].name + "'");
  return names.empty() ? "" : fmt::format("no joint or force element acts on {}", fmt::join(names, ", "));
}

std::string describe_far_element(const Vehicle& vehicle, const Model& model, const Eigen::VectorXd& drawn) {
  SystemTerms terms(model);
  terms.update_positions(0.0, drawn);
  double longest = kFarApart * model.length_scale;
  std::string text;
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
    if (!vehicle.forces[f].along_line) continue;
    const std::vector<int> markers = model.forces[f]->markers();
    const auto place = [&](int marker) { return terms.markers()[static_cast<std::size_t>(marker)].r; };
    const double length = (place(markers[0]) - place(markers[1])).norm();
    if (length <= longest) continue;
    longest = length;
    text =
        fmt::format("as drawn, 'forces.{}' is {:.4g} m long: check the positions of the bodies that it joins",
                    vehicle.forces[f].name, length);
  }
  return text;
}

}  // namespace sprung::dynamics
