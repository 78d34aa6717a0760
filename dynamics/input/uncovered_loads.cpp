#include "dynamics/input/uncovered_loads.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
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

FreedomSet list_interface(const reduce::Superelement& superelement) {
  FreedomSet freedoms;
  for (const reduce::InterfaceError& one : superelement.certificate->interface)
    freedoms.insert({superelement.points[static_cast<std::size_t>(one.point)].node, one.freedom});
  return freedoms;
}

// The freedoms of a loaded point that are not in the interface.
std::vector<int> find_uncovered(const reduce::Superelement& superelement, Eigen::Index node, bool turned) {
  const FreedomSet interface = list_interface(superelement);
  std::vector<int> freedoms;
  for (int freedom = 0; freedom < (turned ? 3 : 2); ++freedom)
    if (!interface.contains({static_cast<int>(node), freedom})) freedoms.push_back(freedom);
  return freedoms;
}

// What [interface] of the design needs, as `front = "xyr", rear = "xy"`: for each node with loads its
// freedoms there and those that are missing.
std::string list_needed(const reduce::Superelement& superelement, const std::vector<UncoveredLoad>& loads) {
  const FreedomSet interface = list_interface(superelement);
  std::map<int, FreedomSet> needed;
  for (const UncoveredLoad& load : loads) {
    const auto node = static_cast<int>(load.node);
    for (const int freedom : load.freedoms) needed[node].insert({node, freedom});
    for (int freedom = 0; freedom < 3; ++freedom)
      if (interface.contains({node, freedom})) needed[node].insert({node, freedom});
  }
  std::vector<std::string> entries;
  for (const auto& [node, freedoms] : needed) {
    const auto named = std::find_if(superelement.points.begin(), superelement.points.end(),
                                    [node = node](const auto& point) { return point.node == node; });
    std::string letters;
    for (const auto& one : freedoms) letters += "xyr"[one.second];
    entries.push_back(named == superelement.points.end()
                          ? fmt::format("a point at the body's frame, with \"{}\"", letters)
                          : fmt::format("{} = \"{}\"", named->name, letters));
  }
  return fmt::format("{}", fmt::join(entries, ", "));
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
    std::vector<int> freedoms = find_uncovered(*superelement, node, turned);
    if (freedoms.empty()) continue;
    loads.push_back(
        {.body = points[i].body, .point = points[i].name, .node = node, .freedoms = std::move(freedoms)});
  }
  return loads;
}

std::string UncoveredLoad::describe() const {
  return fmt::format("{} takes loads, but '{}' is not in the interface of its superelement", point,
                     reduce::freedom_name(freedoms.front()));
}

std::vector<std::string> list_uncovered_loads(const Vehicle& vehicle, const Model& model) {
  std::map<int, std::vector<UncoveredLoad>> by_body;
  for (UncoveredLoad& load : find_uncovered_loads(vehicle, model))
    by_body[load.body].push_back(std::move(load));
  std::vector<std::string> remarks;
  for (const auto& [index, loads] : by_body) {
    const BodyDescription& body = vehicle.bodies[static_cast<std::size_t>(index)];
    const reduce::Superelement& superelement = *vehicle.superelement_of(body);
    const bool holds_all = superelement.certificate->cutoff_hz == 0.0;
    if (holds_all || !superelement.certificate->is_bounded()) continue;
    std::vector<std::string> others;
    for (std::size_t i = 1; i < loads.size(); ++i) others.push_back(loads[i].point);
    remarks.push_back(fmt::format(
        "{}: {}{}: the basis was not made for such loads, and its certified error says nothing of them; "
        "[interface] of the design also needs {}",
        support::format_place(body.location), loads.front().describe(),
        others.empty() ? "" : fmt::format("; likewise {}", fmt::join(others, ", ")),
        list_needed(superelement, loads)));
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
