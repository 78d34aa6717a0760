#include "dynamics/input/unit_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/road/road_spectrum.h"

namespace sprung::dynamics {

namespace {

constexpr double kEarth = 9.80665;         // m/s²
constexpr double kLongest = 100.0;         // m, of a vehicle
constexpr double kLargestWheel = 10.0;     // m, also of an air spring
constexpr double kLargestArea = 3.0;       // m², of an air spring
constexpr double kLargestVolume = 3.0;     // m³
constexpr double kLargestGyration = 50.0;  // m
constexpr double kFastest = 70.0;          // m/s, of a road vehicle
// A body whose points are this much nearer than its radius of gyration, which is longer than kLongGyration.
constexpr double kWideGyration = 10.0;
constexpr double kLongGyration = 3.0;                    // m
constexpr double kLargestDeflection = 10.0;              // m, of a spring under a body's own weight
constexpr double kLeastDamping = 3e-3;                   // of critical, of the lighter body on the spring
constexpr double kSlowestDamping = 50.0;                 // s, of the lighter body on a damper alone
constexpr double kLongestPresliding = 0.1;               // m
constexpr double kLeastPressure = 1000.0;                // Pa
constexpr double kHighestBump = 5.0;                     // m
constexpr double kRoughestRoad = 1.0;                    // m³ at 0.1 1/m: four times that of class H
constexpr double kLargestRms = 1.0;                      // m, of a random road
constexpr double kStrongestGravity = 1000.0;             // m/s², more than 100 g: a centrifuge has less
constexpr double kLargestTurn = 2.0 * std::numbers::pi;  // rad, of a body or a bushing as drawn

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
  if (std::abs(body.angle) > kLargestTurn) {
    remarks.push_back(remark_at(
        body.angle_location,
        fmt::format(
            "'bodies.{}.angle' is {:.4g} rad, more than a full turn; angles are in rad, not in degrees",
            body.name, body.angle)));
  }
  remark_on_inertia(body, remarks);
}

void remark_on_force(const ForceDescription& force, std::vector<std::string>& remarks) {
  const auto check = [&](const char* key, double value, double largest, const char* unit, const char* rule) {
    if (value <= largest) return;
    remarks.push_back(remark_at(
        force.location, fmt::format("'forces.{}.{}' is {:.4g} {}; {}", force.name, key, value, unit, rule)));
  };
  constexpr const char* kLengths = "lengths are in m, not in mm";
  if (const auto* spring = std::get_if<SpringDamper::Parameters>(&force.parameters)) {
    check("free_length", spring->free_length, kLongest, "m", kLengths);
  } else if (const auto* leaf = std::get_if<LeafSpring::Parameters>(&force.parameters)) {
    check("free_length", leaf->free_length, kLongest, "m", kLengths);
    check("presliding_deflection", leaf->presliding_deflection, kLongestPresliding, "m", kLengths);
  } else if (const auto* bushing = std::get_if<Bushing::Parameters>(&force.parameters)) {
    check("angle", std::abs(bushing->angle), kLargestTurn, "rad", "angles are in rad, not in degrees");
  } else if (const auto* stop = std::get_if<HydraulicStop::Parameters>(&force.parameters)) {
    check("contact_length", stop->contact_length, kLongest, "m", kLengths);
  } else if (const auto* tyre = std::get_if<TyreDescription>(&force.parameters)) {
    check("radius", tyre->parameters.radius, kLargestWheel, "m", kLengths);
  } else if (const auto* air = std::get_if<AirSpring::Parameters>(&force.parameters)) {
    const double area = air->effective_area.value(air->design_height);
    check("design_height", air->design_height, kLargestWheel, "m", kLengths);
    check("effective_area", area, kLargestArea, "m²", "areas are in m², not in cm² or mm²");
    const double widest =
        std::max({air->auxiliary_area, air->line_area, air->levelling ? air->levelling->area : 0.0});
    check("orifice", widest, area, "m², which is more than the effective_area", kLengths);
    check("volume", air->volume, kLargestVolume, "m³", "volumes are in m³, not in litres");
    const double gauge = air->pressure - air->ambient_pressure;
    if (!force.static_length && gauge > 0.0 && gauge < kLeastPressure) {
      remarks.push_back(
          remark_at(force.location,
                    fmt::format("'forces.{}.gauge_pressure' is {:.4g} Pa; pressures are in Pa, not in bar",
                                force.name, gauge)));
    }
  }
}

// Mass of the lightest body that an element acts on; 0 if one has none.
double find_lightest(const Vehicle& vehicle, const ForceDescription& force) {
  double lightest = std::numeric_limits<double>::infinity();
  for (const PointReference& point : force.points) {
    const BodyDescription* body = vehicle.find_body(body_of_point(point.name));
    if (body == nullptr) continue;  // the ground
    const reduce::Superelement* superelement = vehicle.superelement_of(*body);
    lightest = std::min(lightest, superelement != nullptr ? superelement->inertia.mass : body->mass);
  }
  return lightest;
}

void remark_on_rates(const Vehicle& vehicle, const ForceDescription& force,
                     std::vector<std::string>& remarks) {
  const double mass = find_lightest(vehicle, force), weight = mass * vehicle.gravity.norm();
  if (!(weight > 0.0) || !std::isfinite(weight)) return;
  if (const auto* tyre = std::get_if<TyreDescription>(&force.parameters)) {
    const Tyre::Parameters& tyres = tyre->parameters;
    const double most = tyres.multiplicity * tyres.spring.value(tyres.radius);
    if (most >= weight) return;
    remarks.push_back(remark_at(
        force.location,
        fmt::format(
            "'forces.{}' carries at most {:.3g} N, less than the weight of its wheel's body, {:.3g} N; "
            "stiffnesses are in N/m, not in N/mm",
            force.name, most, weight)));
  }
  const auto check_spring = [&](double rate, double multiplicity) {
    if (!(rate > 0.0) || weight / (multiplicity * rate) <= kLargestDeflection) return;
    remarks.push_back(remark_at(
        force.location,
        fmt::format(
            "'forces.{}.spring' has {:.3g} N/m, which the weight of the lighter body on it, {:.3g} N, "
            "compresses by {:.3g} m; stiffnesses are in N/m, not in N/mm",
            force.name, rate, weight, weight / (multiplicity * rate))));
  };
  if (const auto* leaf = std::get_if<LeafSpring::Parameters>(&force.parameters))
    check_spring(leaf->spring.slope(0.0), leaf->multiplicity);
  if (const auto* bushing = std::get_if<Bushing::Parameters>(&force.parameters)) {
    const auto slope = [&](std::size_t axis) { return bushing->directions[axis].spring.slope(0.0); };
    check_spring(std::max(slope(0), slope(1)), bushing->multiplicity);
  }
  const auto* spring = std::get_if<SpringDamper::Parameters>(&force.parameters);
  if (spring == nullptr) return;
  const double begin = std::max(0.0, spring->rebound_stop.value_or(0.0));  // of the travel between the stops
  const double rate = spring->multiplicity * spring->spring.slope(begin);
  check_spring(rate / spring->multiplicity, spring->multiplicity);
  const double damping =
      spring->multiplicity * std::max(spring->damper.slope(0.1), spring->damper.slope(-0.1));
  if (rate > 0.0 && damping > 0.0 && damping < kLeastDamping * 2.0 * std::sqrt(rate * mass)) {
    remarks.push_back(remark_at(
        force.location,
        fmt::format("'forces.{}.damper' has {:.3g} N·s/m, {:.2g} % of critical for the lighter body on it; "
                    "dampers are in N·s/m, not in N·s/mm",
                    force.name, damping / spring->multiplicity, 50.0 * damping / std::sqrt(rate * mass))));
  } else if (rate == 0.0 && damping > 0.0 && mass / damping > kSlowestDamping) {
    remarks.push_back(remark_at(
        force.location,
        fmt::format(
            "'forces.{}.damper' has {:.3g} N·s/m, which slows the lighter body on it down in {:.3g} s; "
            "dampers are in N·s/m, not in N·s/mm",
            force.name, damping / spring->multiplicity, mass / damping)));
  }
}

void remark_on_density(const RoadSpectrum& spectrum, const char* key, const support::SourceLocation& location,
                       std::vector<std::string>& remarks) {
  const double density = spectrum.density(RoadSpectrum::kReferenceWavenumber);
  if (density <= kRoughestRoad) return;
  remarks.push_back(remark_at(
      location,
      fmt::format("'{}' has a density of {:.4g} m³ at 0.1 1/m, where class H of ISO 8608 has {:.2g} m³; "
                  "densities are in m³, not in 10⁻⁶ m³",
                  key, density, calc_iso_density('H'))));
}

}  // namespace

std::vector<std::string> list_unit_remarks(const Run& run, const Vehicle& vehicle) {
  std::vector<std::string> remarks;
  if (std::abs(run.speed) > kFastest) {
    remarks.push_back(remark_at(
        run.speed_location,
        fmt::format("'speed' is {:.4g} m/s, or {:.4g} km/h; speeds are in m/s", run.speed, 3.6 * run.speed)));
  }
  if (std::abs(run.road.height) > kHighestBump) {
    remarks.push_back(
        remark_at(run.road.location,
                  fmt::format("'road.height' is {:.4g} m; heights are in m, not in mm", run.road.height)));
  }
  if (run.road.random) {
    remark_on_density(run.road.random->spectrum, "road", run.road.location, remarks);
    if (run.road.random->rms > kLargestRms) {
      remarks.push_back(remark_at(
          run.road.location,
          fmt::format("'road.rms' is {:.4g} m; heights are in m, not in mm", run.road.random->rms)));
    }
  }
  if (run.response.road)
    remark_on_density(*run.response.road, "response.road", run.response.location, remarks);
  if (vehicle.gravity.norm() > kStrongestGravity) {
    remarks.push_back(remark_at(
        vehicle.gravity_location,
        fmt::format("'gravity' is {:.4g} m/s², {:.4g} times that of the Earth; it is in m/s², not in mm/s²",
                    vehicle.gravity.norm(), vehicle.gravity.norm() / kEarth)));
  }
  const bool has_tyres = std::any_of(vehicle.forces.begin(), vehicle.forces.end(),
                                     [](const ForceDescription& force) { return force.on_road; });
  if (has_tyres && vehicle.gravity.y() > 0.0) {
    remarks.push_back(
        remark_at(vehicle.gravity_location,
                  fmt::format("'gravity' points upwards, away from the road: its y is {:.4g} m/s²",
                              vehicle.gravity.y())));
  }
  for (const BodyDescription& body : vehicle.bodies) remark_on_body(body, remarks);
  for (const ForceDescription& force : vehicle.forces) {
    remark_on_force(force, remarks);
    remark_on_rates(vehicle, force, remarks);
  }
  return remarks;
}

}  // namespace sprung::dynamics
