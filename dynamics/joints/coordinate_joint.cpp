#include "dynamics/joints/coordinate_joint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

using Kind = RelativeCoordinate::Kind;

// Largest change of a prescribed motion in one step, in units of the length scale or of 1 rad: it keeps the
// dependent coordinates on the same branch of the mechanism.
constexpr double kLargestMovement = 0.25;

}  // namespace

CoordinateJoint::CoordinateJoint(std::string joint_name, int marker_of_a, int marker_of_b,
                                 support::SourceLocation where, Parts parts)
    : Joint(std::move(joint_name), marker_of_a, marker_of_b, std::move(where)), parts_(std::move(parts)) {
  if (parts_.held.empty() || parts_.held.size() > kMaxJointConstraints) {
    throw std::invalid_argument(fmt::format("CoordinateJoint: holds 1 to {} coordinates, got {}",
                                            kMaxJointConstraints, parts_.held.size()));
  }
}

// Of the forces on a, only that across an axis turns it: it acts at b.
bool CoordinateJoint::carries_torque() const {
  return std::any_of(parts_.held.begin(), parts_.held.end(), [](const Held& one) {
    return one.coordinate.is_angle() || one.coordinate.kind() == Kind::kAlong;
  });
}

bool CoordinateJoint::carries_torque_at_b() const {
  return std::any_of(parts_.held.begin(), parts_.held.end(),
                     [](const Held& one) { return one.coordinate.is_angle(); });
}

void CoordinateJoint::calc_residual(const MarkerState& a, const MarkerState& b, double time,
                                    JointVector& phi) const {
  phi.resize(num_constraints());
  for (int k = 0; k < num_constraints(); ++k)
    phi[k] = held(k).coordinate.value(a, b) - held(k).value.value(time);
}

void CoordinateJoint::calc_jacobian(const MarkerState& a, const MarkerState& b, JointJacobian& Ga,
                                    JointJacobian& Gb) const {
  Ga.resize(num_constraints(), 3);
  Gb.resize(num_constraints(), 3);
  for (int k = 0; k < num_constraints(); ++k) {
    const RelativeCoordinate::Gradient G = held(k).coordinate.gradient(a, b);
    Ga.row(k) = G.a;
    Gb.row(k) = G.b;
  }
}

bool CoordinateJoint::has_constant_jacobian() const {
  return std::all_of(parts_.held.begin(), parts_.held.end(),
                     [](const Held& one) { return one.coordinate.has_constant_gradient(); });
}

void CoordinateJoint::calc_time_rate(const MarkerState& /*a*/, const MarkerState& /*b*/, double time,
                                     JointVector& phi_t) const {
  phi_t.resize(num_constraints());
  for (int k = 0; k < num_constraints(); ++k) phi_t[k] = -held(k).value.rate(time);
}

void CoordinateJoint::calc_drift(const MarkerState& a, const MarkerState& b, double time,
                                 JointVector& drift) const {
  drift.resize(num_constraints());
  for (int k = 0; k < num_constraints(); ++k) {
    drift[k] = held(k).coordinate.drift(a, b) - held(k).value.acceleration(time);
  }
}

std::vector<const TimeFunction*> CoordinateJoint::time_functions() const {
  std::vector<const TimeFunction*> functions;
  for (const Held& one : parts_.held) {
    if (!one.value.is_constant()) functions.push_back(&one.value);
  }
  return functions;
}

double CoordinateJoint::calc_longest_step(double time, double length_scale) const {
  double longest = std::numeric_limits<double>::infinity();
  for (const Held& one : parts_.held) {
    const double rate = std::abs(one.value.rate(time));
    const double size = kLargestMovement * (one.coordinate.is_angle() ? 1.0 : length_scale);
    if (rate > 0.0) longest = std::min(longest, size / rate);
  }
  return longest;
}

CoordinateJoint::Parts make_translational_joint(const Eigen::Vector2d& axis, double angle) {
  return {.kind = "translational",
          .held = {{RelativeCoordinate(Kind::kAlong, turned(axis)), TimeFunction(0.0), "across the axis"},
                   {RelativeCoordinate(Kind::kAngle), TimeFunction(angle), "angle"}},
          .coordinate = RelativeCoordinate(Kind::kAlong, axis),
          .parameters = {{"axis", Eigen::Vector2d(axis.normalized()), "1"}, {"angle", angle, "rad"}}};
}

CoordinateJoint::Parts make_fixed_joint(double angle) {
  return {.kind = "fixed",
          .held = {{RelativeCoordinate(Kind::kX), TimeFunction(0.0), "x"},
                   {RelativeCoordinate(Kind::kY), TimeFunction(0.0), "y"},
                   {RelativeCoordinate(Kind::kAngle), TimeFunction(angle), "angle"}},
          .coordinate = {},
          .parameters = {{"angle", angle, "rad"}}};
}

CoordinateJoint::Parts make_distance_joint(const TimeFunction& length) {
  return {.kind = "distance",
          .held = {{RelativeCoordinate(Kind::kDistance), length, "distance"}},
          .coordinate = RelativeCoordinate(Kind::kDistance),
          .parameters = {{"length", length, "m", "s"}},
          .drawing = Drawing::kRod};
}

CoordinateJoint::Parts make_pin_in_slot_joint(const Eigen::Vector2d& axis) {
  return {.kind = "pin-in-slot",
          .held = {{RelativeCoordinate(Kind::kAlong, turned(axis)), TimeFunction(0.0), "across the slot"}},
          .coordinate = RelativeCoordinate(Kind::kAlong, axis),
          .parameters = {{"axis", Eigen::Vector2d(axis.normalized()), "1"}}};
}

CoordinateJoint::Parts make_motion(const RelativeCoordinate& coordinate, const TimeFunction& value) {
  std::vector<Parameter> parameters{{"coordinate", std::string(coordinate_kind_name(coordinate.kind()))},
                                    {"value", value, coordinate.is_angle() ? "rad" : "m", "s"}};
  if (coordinate.kind() == Kind::kAlong) parameters.push_back({"axis", coordinate.axis(), "1"});
  return {.kind = "motion",
          .held = {{coordinate, value, "motion"}},
          .coordinate = coordinate,
          .parameters = std::move(parameters),
          .drawing = Drawing::kNone,
          .is_motion = true};
}

}  // namespace sprung::dynamics
