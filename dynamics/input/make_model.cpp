#include "dynamics/input/make_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace sprung::dynamics {

namespace {

const std::vector<int>& modes_of(const ModeSelection& selection, const std::string& body) {
  static const std::vector<int> kNone;
  const auto found = selection.find(body);
  return found == selection.end() ? kNone : found->second;
}

// D = diag(2 ζ ω m), with ω m = √(k m) of each mode of the body.
void replace_damping(Body& body, const std::vector<double>& ratios) {
  if (ratios.size() != 1 && ratios.size() != body.mode_numbers.size()) {
    throw std::invalid_argument(fmt::format("make_model: damping of '{}' must be 1 or {} ratios, got {}",
                                            body.name, body.num_modes(), ratios.size()));
  }
  body.damping.setZero();
  for (int k = 0; k < body.num_modes(); ++k) {
    const double ratio = ratios[ratios.size() == 1 ? 0 : static_cast<std::size_t>(k)];
    body.damping(k, k) = 2.0 * ratio * std::sqrt(body.stiffness(k, k) * body.modal_mass[k]);
  }
}

Body make_body(const Vehicle& vehicle, const BodyDescription& description, const ModeSelection& selection,
               const ModalDamping& damping, const StiffenedBodies& stiffened) {
  const std::vector<int>& numbers = modes_of(selection, description.name);
  const reduce::Superelement* superelement = vehicle.superelement_of(description);
  if (superelement == nullptr) {
    if (!numbers.empty()) {
      throw std::invalid_argument(
          fmt::format("make_model: body '{}' has no superelement, so no modes", description.name));
    }
    return make_rigid_body(description.name, description.mass, description.inertia);
  }
  const bool stiffens = stiffened.contains(description.name);
  Body body = make_flexible_body(description.name, *superelement, numbers,
                                 stiffens ? Stiffening::kOn : Stiffening::kOff);
  const auto replaced = damping.find(description.name);
  if (replaced != damping.end() && !numbers.empty()) replace_damping(body, replaced->second);
  return body;
}

// Second-order displacement of a point of a body with stiffening.
SecondOrder make_second_order(const reduce::Superelement& superelement, const VehiclePoint& point,
                              const Body& body) {
  if (point.kind == VehiclePoint::Kind::kCenterOfMass) return {};
  if (point.kind == VehiclePoint::Kind::kFixed)
    return body.stiffening->origin;  // the only one on a superelement
  std::vector<int> columns;
  for (const int number : body.mode_numbers) columns.push_back(number - 1);
  const auto named = std::find_if(superelement.points.begin(), superelement.points.end(),
                                  [&](const reduce::NamedPoint& one) { return one.node == point.node; });
  return calc_second_order(superelement, columns, *body.stiffening,
                           static_cast<int>(named - superelement.points.begin()), point.offset);
}

Marker make_marker(const Vehicle& vehicle, const VehiclePoint& point, const std::vector<Body>& bodies) {
  const int num_modes = point.body == kGround ? 0 : bodies[static_cast<std::size_t>(point.body)].num_modes();
  Marker marker;
  marker.name = point.name;
  marker.body = point.body;
  marker.p_BP = point.p_BP;
  marker.Phi = Eigen::Matrix3Xd::Zero(3, num_modes);
  if (num_modes == 0) return marker;
  const std::size_t b = static_cast<std::size_t>(point.body);
  const reduce::Superelement& superelement = *vehicle.superelement_of(vehicle.bodies[b]);
  if (bodies[b].stiffening) marker.K = make_second_order(superelement, point, bodies[b]);
  if (point.kind == VehiclePoint::Kind::kCenterOfMass) marker.Phi.topRows<2>() = bodies[b].P / bodies[b].mass;
  if (point.kind != VehiclePoint::Kind::kNode) return marker;
  const Eigen::MatrixXd& shapes = superelement.shapes;
  for (int k = 0; k < num_modes; ++k) {
    const int column = bodies[b].mode_numbers[static_cast<std::size_t>(k)] - 1;
    const Eigen::Vector3d shape = shapes.block<3, 1>(3 * point.node, column);
    // The offset turns with the node: u = φ + (S o) φ_rotation.
    marker.Phi.col(k) << shape.head<2>() + turned(point.offset) * shape[2], shape[2];
  }
  return marker;
}

double start_angle(const Vehicle& vehicle, const Marker& marker) {
  return marker.body == kGround ? 0.0 : vehicle.bodies[static_cast<std::size_t>(marker.body)].angle;
}

using MarkerNumbers = std::unordered_map<std::string, int>;  // by name

JointPlace find_joint_place(const Vehicle& vehicle, const Model& model, const MarkerNumbers& numbers,
                            const PointReference& a, const PointReference& b, MotionUse motions) {
  JointPlace place{.marker_a = numbers.at(a.name), .marker_b = numbers.at(b.name), .motions = motions};
  place.angle = start_angle(vehicle, model.markers[static_cast<std::size_t>(place.marker_b)]) -
                start_angle(vehicle, model.markers[static_cast<std::size_t>(place.marker_a)]);
  return place;
}

}  // namespace

Model make_model(const Vehicle& vehicle, const ModeSelection& selection, const PlacedRoad& road,
                 const ModalDamping& damping, MotionUse motions, const StiffenedBodies& stiffened) {
  for (const auto& [body, numbers] : selection) {
    if (vehicle.find_body(body) == nullptr) {
      throw std::invalid_argument(fmt::format("make_model: modes selected of '{}', which is no body", body));
    }
  }
  Model model;
  model.gravity = vehicle.gravity;
  for (const BodyDescription& body : vehicle.bodies) {
    model.bodies.push_back(make_body(vehicle, body, selection, damping, stiffened));
  }
  MarkerNumbers numbers;
  for (const VehiclePoint& point : list_points(vehicle)) {
    numbers.emplace(point.name, static_cast<int>(model.markers.size()));
    model.markers.push_back(make_marker(vehicle, point, model.bodies));
  }
  for (const JointDescription& joint : vehicle.joints) {
    model.joints.push_back(
        make_joint(joint, find_joint_place(vehicle, model, numbers, joint.a, joint.b, motions)));
  }
  for (const MotionDescription& motion : vehicle.motions) {
    model.joints.push_back(
        make_joint(motion, find_joint_place(vehicle, model, numbers, motion.a, motion.b, motions)));
  }
  for (const ForceDescription& force : vehicle.forces) {
    if (force.on_road && road.road == nullptr) {
      throw std::invalid_argument(fmt::format("make_model: force '{}' needs a road, got none", force.name));
    }
    std::vector<int> markers;
    for (const PointReference& point : force.points) markers.push_back(numbers.at(point.name));
    model.forces.push_back(make_force(force, markers, road));
  }
  number_model(model);
  return model;
}

Eigen::VectorXd make_start_positions(const Model& model, const Vehicle& vehicle) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_coordinates);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyDescription& description = vehicle.bodies[b];
    q.segment<3>(model.bodies[b].first_coordinate) << description.position, description.angle;
  }
  return q;
}

double find_leading_position(const Model& model, const Vehicle& vehicle,
                             std::span<const MarkerState> markers) {
  double leading = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const std::string& point_name) {
    const int marker = model.find_marker(point_name);
    leading = std::max(leading, vehicle.direction * markers[static_cast<std::size_t>(marker)].r.x());
  };
  for (const ForceDescription& force : vehicle.forces) {
    if (force.on_road) consider(force.points.front().name);
  }
  if (std::isfinite(leading)) return leading;
  for (const BodyDescription& body : vehicle.bodies) consider(body.name + ".origin");
  return leading;
}

}  // namespace sprung::dynamics
