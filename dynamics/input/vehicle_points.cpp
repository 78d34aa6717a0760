#include <algorithm>

#include "dynamics/bodies/marker.h"
#include "dynamics/input/vehicle.h"

namespace sprung::dynamics {

namespace {

// A named node at the frame's origin may be called "origin": it is the same point.
void add_nodes(const reduce::Superelement& superelement, int body, const std::string& prefix,
               std::vector<VehiclePoint>& points) {
  for (const reduce::NamedPoint& named : superelement.points) {
    if (named.name == "origin" || named.name == "center_of_mass") continue;
    points.push_back({.name = prefix + named.name,
                      .kind = VehiclePoint::Kind::kNode,
                      .body = body,
                      .p_BP = superelement.node_positions.col(named.node),
                      .node = named.node});
  }
}

VehiclePoint place_point(const PointDescription& point, const reduce::Superelement* superelement, int body,
                         const std::string& prefix) {
  VehiclePoint placed{.name = prefix + point.name, .body = body, .p_BP = point.position};
  if (superelement == nullptr) return placed;
  placed.kind = VehiclePoint::Kind::kNode;
  placed.node = reduce::find_point(*superelement, point.node);
  placed.p_BP = superelement->node_positions.col(placed.node) + point.position;
  placed.offset = point.position;
  return placed;
}

}  // namespace

std::vector<VehiclePoint> list_points(const Vehicle& vehicle) {
  std::vector<VehiclePoint> points;
  for (std::size_t b = 0; b < vehicle.bodies.size(); ++b) {
    const BodyDescription& body = vehicle.bodies[b];
    const reduce::Superelement* superelement = vehicle.superelement_of(body);
    const int index = static_cast<int>(b);
    const std::string prefix = body.name + ".";
    points.push_back({.name = prefix + "origin", .body = index});
    VehiclePoint center{
        .name = prefix + "center_of_mass", .kind = VehiclePoint::Kind::kCenterOfMass, .body = index};
    if (superelement != nullptr)
      center.p_BP = superelement->inertia.first_moment / superelement->inertia.mass;
    points.push_back(center);
    if (superelement != nullptr) add_nodes(*superelement, index, prefix, points);
    for (const PointDescription& point : body.points) {
      points.push_back(place_point(point, superelement, index, prefix));
    }
  }
  for (const PointDescription& point : vehicle.ground_points) {
    points.push_back(place_point(point, nullptr, kGround, "ground."));
  }
  points.push_back({.name = "ground.origin", .body = kGround});
  return points;
}

std::vector<std::string> point_names(const Vehicle& vehicle) {
  std::vector<std::string> names;
  for (const VehiclePoint& point : list_points(vehicle)) names.push_back(point.name);
  return names;
}

}  // namespace sprung::dynamics
