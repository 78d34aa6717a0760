#include "dynamics/input/vehicle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "dynamics/bodies/body_equations.h"
#include "dynamics/input/body_input.h"

namespace sprung::dynamics {

namespace {

template <typename Description>
void check_new_name(const std::vector<Description>& others, const Description& added, const char* what) {
  const auto same = [&](const Description& other) { return other.name == added.name; };
  const auto found = std::find_if(others.begin(), others.end(), same);
  if (found == others.end()) return;
  throw support::InputError(added.location, fmt::format("there is a {} '{}' already, in line {}", what,
                                                        added.name, found->location.line));
}

std::vector<JointDescription> read_joints(const support::TomlTable& root, std::span<const std::string> points,
                                          HistoryFiles& histories) {
  std::vector<JointDescription> joints;
  const std::optional<support::TomlValue> list = root.find("joints");
  if (!list) return joints;
  for (const support::TomlValue& item : list->items()) {
    JointDescription joint = read_joint(item.table(), histories);
    check_new_name(joints, joint, "joint");
    check_point(joint.a, points);
    check_point(joint.b, points);
    const std::string body = body_of_point(joint.a.name);
    if (body == body_of_point(joint.b.name)) {
      throw support::InputError(joint.b.location,
                                fmt::format("joint '{}' must join two bodies, '{}' and '{}' are both "
                                            "on '{}'",
                                            joint.name, joint.a.name, joint.b.name, body));
    }
    joints.push_back(std::move(joint));
  }
  return joints;
}

std::vector<MotionDescription> read_motions(const support::TomlTable& root,
                                            const std::vector<JointDescription>& joints,
                                            std::span<const std::string> points, HistoryFiles& histories) {
  std::vector<MotionDescription> motions;
  const std::optional<support::TomlValue> list = root.find("motions");
  if (!list) return motions;
  for (const support::TomlValue& item : list->items()) {
    MotionDescription motion = read_motion(item.table(), joints, histories);
    check_new_name(motions, motion, "motion");
    const auto same = [&](const JointDescription& joint) { return joint.name == motion.name; };
    if (std::any_of(joints.begin(), joints.end(), same)) {
      throw support::InputError(motion.location,
                                fmt::format("motion '{}' has the name of a joint", motion.name));
    }
    check_point(motion.b, points);
    if (body_of_point(motion.a.name) == kGroundName && body_of_point(motion.b.name) == kGroundName) {
      throw support::InputError(motion.b.location, fmt::format("motion '{}' moves the ground", motion.name));
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

std::vector<ForceDescription> read_forces(const support::TomlTable& root, std::span<const std::string> points,
                                          HistoryFiles& histories) {
  std::vector<ForceDescription> forces;
  const std::optional<support::TomlValue> list = root.find("forces");
  if (!list) return forces;
  for (const support::TomlValue& item : list->items()) {
    ForceDescription force = read_force(item.table(), histories);
    check_new_name(forces, force, "force");
    for (const PointReference& point : force.points) check_point(point, points);
    forces.push_back(std::move(force));
  }
  return forces;
}

std::vector<PointReference> read_monitor(const support::TomlTable& root, const Vehicle& vehicle,
                                         std::span<const std::string> points) {
  std::vector<PointReference> monitor;
  const std::optional<support::TomlValue> list = root.find("monitor");
  if (!list) {
    for (const BodyDescription& body : vehicle.bodies)
      monitor.push_back({body.name + ".origin", body.location});
    return monitor;
  }
  for (const support::TomlValue& item : list->items()) {
    monitor.push_back(read_point(item));
    check_point(monitor.back(), points);
  }
  if (monitor.empty()) {
    throw list->error(
        "must name at least one point \"body.point\"; leave it out for the origin of every body");
  }
  return monitor;
}

// `[modes] judge`.
JudgedQuantities read_judged(const support::TomlTable& table) {
  static const std::array<std::string, 4> kKinds{"points", "moments", "forces", "reactions"};
  const std::optional<support::TomlValue> list = table.find("judge");
  table.reject_unknown_keys();
  if (!list) return {};
  JudgedQuantities judged{.points = false, .moments = false, .forces = false, .reactions = false};
  const std::array<bool*, 4> flags{&judged.points, &judged.moments, &judged.forces, &judged.reactions};
  bool is_any = false;
  for (const support::TomlValue& item : list->items()) {
    const std::string& kind = item.one_of(kKinds);
    bool& flag =
        *flags[static_cast<std::size_t>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin())];
    if (flag) throw item.error(fmt::format("names \"{}\" twice", kind));
    flag = is_any = true;
  }
  if (!is_any) {
    throw list->error(
        "must name at least one of \"points\", \"moments\", \"forces\", \"reactions\"; leave it out for the "
        "first two");
  }
  return judged;
}

Eigen::Vector2d start_position(const Vehicle& vehicle, const std::vector<VehiclePoint>& points,
                               const std::string& name) {
  const auto found =
      std::find_if(points.begin(), points.end(), [&](const VehiclePoint& p) { return p.name == name; });
  if (found->body < 0) return found->p_BP;
  const BodyDescription& body = vehicle.bodies[static_cast<std::size_t>(found->body)];
  return body.position + FrameRotation::from_angle(body.angle) * found->p_BP;
}

// Rejects masses that differ too much for arithmetic of 16 digits, and inertias that do not match the mass.
void check_masses(const Vehicle& vehicle) {
  constexpr double kMostRatio = 1e12, kMostRadius = 1e9;
  std::vector<double> masses;
  for (const BodyDescription& body : vehicle.bodies) {
    const reduce::Superelement* superelement = vehicle.superelement_of(body);
    masses.push_back(superelement != nullptr ? superelement->inertia.mass : body.mass);
  }
  std::vector<double> sorted = masses;
  std::erase(sorted, 0.0);
  if (sorted.empty()) {
    throw support::InputError(vehicle.bodies.front().mass_location, "no body of the vehicle has a mass");
  }
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double largest = *std::max_element(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const BodyDescription& body = vehicle.bodies[i];
    if (!body.superelement.empty() || body.mass == 0.0) continue;
    const double ratio = body.mass / *middle;
    if (ratio > kMostRatio || ratio < 1.0 / kMostRatio) {
      throw support::InputError(
          body.mass_location,
          fmt::format("'bodies.{}.mass' is {:g} kg, where half of the bodies have {} {:g} kg: more than a "
                      "factor of {:g} apart they cannot be calculated together",
                      body.name, body.mass, ratio > 1.0 ? "at most" : "at least", *middle, kMostRatio));
    }
    if (body.mass < largest / kMostRatio) {
      throw support::InputError(
          body.mass_location,
          fmt::format(
              "'bodies.{}.mass' is {:g} kg beside a body of {:g} kg: more than a factor of {:g} apart "
              "they cannot be calculated together; give it more, or none",
              body.name, body.mass, largest, kMostRatio));
    }
    if (body.inertia == 0.0) continue;
    const double radius = std::sqrt(body.inertia / body.mass);
    if (radius > kMostRadius || radius < 1.0 / kMostRadius) {
      throw support::InputError(
          body.inertia_location,
          fmt::format("'bodies.{}.inertia' is {:g} kg·m², which for a mass of {:g} kg is a radius of "
                      "gyration of {:g} m; expected {:g} to {:g} m",
                      body.name, body.inertia, body.mass, radius, 1.0 / kMostRadius, kMostRadius));
    }
  }
}

// The line of action of a force or a link needs a direction at the start.
void check_lines(const Vehicle& vehicle) {
  const std::vector<VehiclePoint> points = list_points(vehicle);
  const auto check = [&](const auto& acting, const char* what, const PointReference& point_a,
                         const PointReference& point_b) {
    const Eigen::Vector2d a = start_position(vehicle, points, point_a.name);
    const Eigen::Vector2d b = start_position(vehicle, points, point_b.name);
    if ((b - a).norm() > 1e-9) return;
    throw support::InputError(acting.location,
                              fmt::format("{} '{}' acts along the line between '{}' and '{}', which "
                                          "are at one place ({:.6g} m, {:.6g} m)",
                                          what, acting.name, point_a.name, point_b.name, a.x(), a.y()));
  };
  for (const ForceDescription& force : vehicle.forces) {
    if (!force.along_line) continue;
    for (std::size_t i = 0; i < force.points.size(); i += 2)
      check(force, "force", force.points[i], force.points[i + 1]);
  }
  for (const JointDescription& joint : vehicle.joints) {
    if (joint.along_line) check(joint, "joint", joint.a, joint.b);
  }
}

}  // namespace

const BodyDescription* Vehicle::find_body(const std::string& body_name) const {
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const BodyDescription& body) { return body.name == body_name; });
  return found == bodies.end() ? nullptr : &*found;
}

const reduce::Superelement* Vehicle::superelement_of(const BodyDescription& body) const {
  const auto found = superelements.find(body.superelement);
  return found == superelements.end() ? nullptr : &found->second;
}

std::vector<std::string> Vehicle::body_names() const {
  std::vector<std::string> names;
  for (const BodyDescription& body : bodies) names.push_back(body.name);
  return names;
}

Vehicle read_vehicle(const support::TomlDocument& document, const std::filesystem::path& superelement_folder,
                     SuperelementCache* cache) {
  const support::TomlTable root = document.root();
  Vehicle vehicle;
  vehicle.text = document.text();
  vehicle.name = root.string("name");
  static const std::array<std::string, 2> kHeadings{"+x", "-x"};
  if (const std::optional<support::TomlValue> heading = root.find("heading")) {
    vehicle.direction = heading->one_of(kHeadings) == "+x" ? 1.0 : -1.0;
  }
  if (const std::optional<support::TomlValue> gravity = root.find("gravity")) {
    const std::vector<double> g = gravity->numbers(support::any("m/s²"), 2);
    vehicle.gravity = {g[0], g[1]};
    vehicle.gravity_location = gravity->location();
  }
  vehicle.bodies = read_bodies(root.at("bodies").table());
  if (const std::optional<support::TomlTable> ground = root.find_table("ground")) {
    vehicle.ground_points = read_points(ground->at("points").table(), false);
    ground->reject_unknown_keys();
  }
  if (const std::optional<support::TomlTable> modes = root.find_table("modes"))
    vehicle.judged = read_judged(*modes);
  // Unknown keys are reported before other files are read.
  for (const std::string_view key : {"joints", "motions", "forces", "monitor"}) root.find(key);
  root.reject_unknown_keys();
  vehicle.superelements = read_superelements(vehicle.bodies, superelement_folder, cache);
  check_masses(vehicle);
  const std::vector<std::string> points = point_names(vehicle);
  HistoryFiles histories(std::filesystem::path(document.name()).parent_path());
  vehicle.joints = read_joints(root, points, histories);
  vehicle.motions = read_motions(root, vehicle.joints, points, histories);
  vehicle.forces = read_forces(root, points, histories);
  vehicle.histories = histories.used();
  vehicle.monitor = read_monitor(root, vehicle, points);
  check_lines(vehicle);
  return vehicle;
}

}  // namespace sprung::dynamics
