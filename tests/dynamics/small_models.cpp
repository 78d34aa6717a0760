#include "tests/dynamics/small_models.h"

#include <cmath>
#include <memory>
#include <utility>

#include "dynamics/joints/revolute_joint.h"

namespace sprung::test {

using namespace dynamics;

int add_body(Model& model, Body body) {
  model.bodies.push_back(std::move(body));
  return static_cast<int>(model.bodies.size()) - 1;
}

int add_marker(Model& model, int body, const Eigen::Vector2d& p, const std::string& name) {
  const bool on_ground = body == kGround;
  const int num_modes = on_ground ? 0 : model.bodies[static_cast<std::size_t>(body)].num_modes();
  Marker marker;
  marker.name = (on_ground ? "ground." : model.bodies[static_cast<std::size_t>(body)].name + ".") + name;
  marker.body = body;
  marker.p_BP = p;
  marker.Phi = Eigen::Matrix3Xd::Zero(3, num_modes);
  model.markers.push_back(marker);
  return static_cast<int>(model.markers.size()) - 1;
}

int add_node_marker(Model& model, int body, const reduce::Superelement& superelement, int node,
                    const Eigen::Vector2d& offset) {
  const int index = add_marker(model, body, superelement.node_positions.col(node) + offset);
  Marker& marker = model.markers.back();
  const std::vector<int>& modes = model.bodies[static_cast<std::size_t>(body)].mode_numbers;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const Eigen::Vector3d shape = superelement.shapes.block<3, 1>(3 * node, modes[k] - 1);
    const auto column = static_cast<Eigen::Index>(k);
    marker.Phi.col(column) << shape[0] - shape[2] * offset.y(), shape[1] + shape[2] * offset.x(), shape[2];
  }
  return index;
}

void add_pin(Model& model, const std::string& name, int marker_a, int marker_b) {
  model.joints.push_back(
      std::make_unique<RevoluteJoint>(name, marker_a, marker_b, support::SourceLocation{"test.toml", 1, 1}));
}

void add_spring(Model& model, const std::string& name, int marker_a, int marker_b, double free_length,
                double k, double c) {
  model.forces.push_back(std::make_unique<SpringDamper>(
      name, SpringDamper::Parameters{.marker_a = marker_a,
                                     .marker_b = marker_b,
                                     .free_length = free_length,
                                     .spring = PiecewisePolynomial(std::vector<double>{0.0, k}),
                                     .damper = PiecewisePolynomial(std::vector<double>{0.0, c})}));
}

Model make_pendulum(double mass, double arm, double length, double gravity) {
  Model model;
  model.gravity = {0.0, -gravity};
  // Inertia about the pivot over static moment: (I + m a²)/(m a) = length.
  const int bar = add_body(model, make_rigid_body("bar", mass, mass * arm * (length - arm)));
  const int pivot = add_marker(model, bar, {-arm, 0.0}, "pivot");
  const int ground = add_marker(model, kGround, {0.0, 0.0}, "pivot");
  add_marker(model, bar, {length - arm, 0.0}, "bob");
  add_pin(model, "pivot", pivot, ground);
  number_model(model);
  return model;
}

Eigen::Vector3d place_pendulum(double arm, double angle) {
  return {arm * std::cos(angle), arm * std::sin(angle), angle};
}

State make_state(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  return {.time = 0.0,
          .q = q,
          .v = v,
          .branches = std::vector<int>(static_cast<std::size_t>(model.num_branches))};
}

}  // namespace sprung::test
