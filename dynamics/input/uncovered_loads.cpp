#include "dynamics/input/uncovered_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "tools/support/toml/toml.h"

namespace sprung::dynamics {

namespace {

using FreedomSet = std::set<std::pair<int, int>>;  // node, freedom

// The markers that carry torque: those of joints and force elements that exert one.
std::vector<bool> find_turned_markers(const Model& model) {
  std::vector<bool> turned(model.markers.size(), false);
  for (const auto& joint : model.joints) {
    if (joint->carries_torque()) turned[static_cast<std::size_t>(joint->marker_a)] = true;
    if (joint->carries_torque_at_b()) turned[static_cast<std::size_t>(joint->marker_b)] = true;
  }
  for (const auto& force : model.forces) {
    for (const int marker : force->turned_markers()) turned[static_cast<std::size_t>(marker)] = true;
  }
  return turned;
}

// The first freedom of a loaded point that is not in the interface.
std::optional<int> find_uncovered(const reduce::Superelement& superelement, Eigen::Index node, bool turned) {
  FreedomSet freedoms;
  for (const reduce::InterfaceError& one : superelement.certificate->interface)
    freedoms.insert({superelement.points[static_cast<std::size_t>(one.point)].node, one.freedom});
  for (int freedom = 0; freedom < (turned ? 3 : 2); ++freedom)
    if (!freedoms.contains({static_cast<int>(node), freedom})) return freedom;
  return {};
}

}  // namespace

std::vector<UncoveredLoad> find_uncovered_loads(const Vehicle& vehicle, const Model& model) {
  std::vector<UncoveredLoad> loads;
  const std::vector<VehiclePoint> points = list_points(vehicle);
  const std::vector<bool> carries_torque = find_turned_markers(model);
  for (const int marker : model.acting_markers) {
    const auto i = static_cast<std::size_t>(marker);
    if (i >= points.size() || points[i].body < 0) continue;
    const auto body = static_cast<std::size_t>(points[i].body);
    const reduce::Superelement* superelement = vehicle.superelement_of(vehicle.bodies[body]);
    if (model.bodies[body].num_modes() == 0 || !superelement || !superelement->certificate) continue;
    if (points[i].kind == VehiclePoint::Kind::kCenterOfMass) continue;  // no elastic motion moves it
    const bool is_fixed = points[i].kind == VehiclePoint::Kind::kFixed;
    const Eigen::Index node = is_fixed ? reduce::find_reference_node(*superelement) : points[i].node;
    const bool turned = carries_torque[i] || !points[i].offset.isZero(0.0);
    if (const std::optional<int> freedom = find_uncovered(*superelement, node, turned))
      loads.push_back({.body = points[i].body, .point = points[i].name, .node = node, .freedom = *freedom});
  }
  return loads;
}

std::string UncoveredLoad::describe() const {
  return fmt::format("{} takes loads, but '{}' is not in the interface of its superelement", point,
                     reduce::freedom_name(freedom));
}

std::vector<std::string> list_uncovered_loads(const Vehicle& vehicle, const Model& model) {
  std::vector<std::string> remarks;
  std::set<int> named;  // bodies
  for (const UncoveredLoad& load : find_uncovered_loads(vehicle, model)) {
    const BodyDescription& body = vehicle.bodies[static_cast<std::size_t>(load.body)];
    const reduce::Certificate& certificate = *vehicle.superelement_of(body)->certificate;
    const bool holds_all = certificate.cutoff_hz == 0.0;
    if (holds_all || !certificate.is_bounded() || !named.insert(load.body).second) continue;
    remarks.push_back(fmt::format(
        "{}: {}: the basis was not made for them, and its certified error says nothing of them; name the "
        "point under [interface] in the design",
        support::format_place(body.location), load.describe()));
  }
  return remarks;
}

std::vector<std::string> list_spread_loads(const Vehicle& vehicle, const Model& model) {
  std::vector<std::string> remarks;
  const std::vector<VehiclePoint> points = list_points(vehicle);
  for (const int marker : model.acting_markers) {
    const auto i = static_cast<std::size_t>(marker);
    if (i >= points.size() || points[i].kind != VehiclePoint::Kind::kCenterOfMass) continue;
    const BodyDescription& body = vehicle.bodies[static_cast<std::size_t>(points[i].body)];
    if (!vehicle.superelement_of(body)) continue;
    remarks.push_back(fmt::format(
        "{}: loads on {} are spread along the body as its mass is, and bend it less than at one place; "
        "for a load at one place, take a point of the design",
        support::format_place(body.location), points[i].name));
  }
  return remarks;
}

}  // namespace sprung::dynamics
