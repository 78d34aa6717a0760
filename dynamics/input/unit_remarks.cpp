#include "dynamics/input/unit_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sprung::dynamics {

namespace {

constexpr double kLongest = 100.0;         // m, of a vehicle
constexpr double kLargestWheel = 10.0;     // m
constexpr double kLargestGyration = 50.0;  // m
constexpr double kFastest = 70.0;          // m/s, of a road vehicle
// A body whose points are this much nearer than its radius of gyration, which is longer than kLongGyration.
constexpr double kWideGyration = 10.0;
constexpr double kLongGyration = 3.0;  // m

std::string remark_at(const support::SourceLocation& location, const std::string& text) {
  return fmt::format("{}: {}", support::format_place(location), text);
}

void remark_on_inertia(const BodyDescription& body, std::vector<std::string>& remarks) {
  if (body.mass <= 0.0) return;
  const double gyration = std::sqrt(body.inertia / body.mass);
  double extent = 0.0;
  for (const PointDescription& point : body.points) extent = std::max(extent, point.position.norm());
  if (gyration > kLargestGyration) {
    remarks.push_back(remark_at(
        body.inertia_location,
        fmt::format(
            "'bodies.{}.inertia' is that of {:.4g} kg at a distance of {:.4g} m; inertias are in kg·m², not "
            "in kg·mm²",
            body.name, body.mass, gyration)));
  } else if (extent > 0.0 && gyration > std::max(kLongGyration, kWideGyration * extent)) {
    remarks.push_back(remark_at(
        body.mass_location,
        fmt::format("'bodies.{}.mass' is {:.4g} kg, whose inertia is that at a distance of {:.4g} m, where "
                    "all points are within {:.4g} m; masses are in kg, not in t",
                    body.name, body.mass, gyration, extent)));
  }
}

void remark_on_body(const BodyDescription& body, std::vector<std::string>& remarks) {
  for (const PointDescription& point : body.points) {
    if (point.position.norm() <= kLongest) continue;
    remarks.push_back(remark_at(
        point.location, fmt::format("'bodies.{}.points.{}' is {:.4g} m away; lengths are in m, not in mm",
                                    body.name, point.name, point.position.norm())));
  }
  remark_on_inertia(body, remarks);
}

void remark_on_force(const ForceDescription& force, std::vector<std::string>& remarks) {
  double length = 0.0, largest = kLongest;
  std::string key;
  if (const auto* spring = std::get_if<SpringDamper::Parameters>(&force.parameters)) {
    length = spring->free_length;
    key = "free_length";
  } else if (const auto* tyre = std::get_if<TyreDescription>(&force.parameters)) {
    length = tyre->parameters.radius;
    largest = kLargestWheel;
    key = "radius";
  }
  if (length <= largest) return;
  remarks.push_back(remark_at(
      force.location,
      fmt::format("'forces.{}.{}' is {:.4g} m; lengths are in m, not in mm", force.name, key, length)));
}

}  // namespace

std::vector<std::string> list_unit_remarks(const Run& run, const Vehicle& vehicle) {
  std::vector<std::string> remarks;
  if (std::abs(run.speed) > kFastest) {
    remarks.push_back(remark_at(
        run.speed_location,
        fmt::format("'speed' is {:.4g} m/s, or {:.4g} km/h; speeds are in m/s", run.speed, 3.6 * run.speed)));
  }
  for (const BodyDescription& body : vehicle.bodies) remark_on_body(body, remarks);
  for (const ForceDescription& force : vehicle.forces) remark_on_force(force, remarks);
  return remarks;
}

}  // namespace sprung::dynamics
