#include "dynamics/preparation/hanging_bodies.h"

#include <algorithm>
#include <optional>
#include <set>

namespace sprung::dynamics {

namespace {

constexpr double kLeastPull = 1e-6;  // of the weight of all bodies

int body_of(const Model& model, int marker) {
  return model.markers[static_cast<std::size_t>(marker)].body;
}

// The force with which a spring pushes its points apart.
double calc_push(const ForceElement& element, std::span<const double> channels) {
  const std::optional<std::size_t> channel = element.find_channel(ChannelRole::kForce);
  return channel ? channels[*channel] : 0.0;
}

// The body and those that joints connect with it, not by way of `above`; none if they reach the ground.
std::set<int> find_joined(const Model& model, int body, int above) {
  std::set<int> joined{body};
  for (std::size_t before = 0; before != joined.size();) {
    before = joined.size();
    for (const auto& joint : model.joints) {
      const int a = body_of(model, joint->marker_a), b = body_of(model, joint->marker_b);
      if (a == above || b == above || joined.contains(a) == joined.contains(b)) continue;
      joined.insert({a, b});
    }
  }
  if (joined.contains(kGround)) joined.clear();
  return joined;
}

// Whether an element that acts on one of the bodies acts on others than these and `above`, or on the road.
bool is_held(const Vehicle& vehicle, const Model& model, const std::set<int>& bodies, int above) {
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const std::vector<int> markers = model.forces[f]->markers();
    const auto acts_on = [&](const auto& is_meant) {
      return std::any_of(markers.begin(), markers.end(),
                         [&](int marker) { return is_meant(body_of(model, marker)); });
    };
    if (!acts_on([&](int body) { return bodies.contains(body); })) continue;
    if (vehicle.forces[f].on_road || markers.size() < 2 ||
        acts_on([&](int body) { return body != above && !bodies.contains(body); }))
      return true;
  }
  return false;
}

}  // namespace

std::vector<HangingBody> find_hanging_bodies(const Vehicle& vehicle, const Model& model,
                                             const RestingForces& at_rest) {
  double weight = 0.0;
  for (const Body& body : model.bodies) weight += body.mass * model.gravity.norm();
  std::vector<HangingBody> found;
  for (std::size_t f = 0; f < vehicle.forces.size(); ++f) {
    if (!vehicle.forces[f].along_line || !vehicle.forces[f].static_length) continue;
    const double pull = -calc_push(*model.forces[f], at_rest.calc_channels(f));
    if (!(pull > kLeastPull * weight)) continue;
    const std::vector<int> markers = model.forces[f]->markers();
    const auto place = [&](int marker) {
      return at_rest.terms().markers()[static_cast<std::size_t>(marker)].r;
    };
    const bool is_b_lower = (place(markers[1]) - place(markers[0])).dot(model.gravity) > 0.0;
    const int lower = body_of(model, markers[is_b_lower ? 1 : 0]),
              above = body_of(model, markers[is_b_lower ? 0 : 1]);
    if (lower == kGround || lower == above) continue;
    const std::set<int> bodies = find_joined(model, lower, above);
    if (bodies.empty() || is_held(vehicle, model, bodies, above)) continue;
    found.push_back({.force = f, .body = lower, .pull = pull});
  }
  return found;
}

}  // namespace sprung::dynamics
