#include "fem/axial_force.h"

#include <fmt/format.h>

#include <stdexcept>

namespace sprung::fem {

namespace {

// Load along the element per length at r from the frame's origin, t its direction (fem, eq. 23).
double calc_axial_load(const FrameAcceleration& acceleration, double mass_per_length,
                       const Eigen::Vector2d& r, const Eigen::Vector2d& t) {
  const Eigen::Vector2d turned(-r.y(), r.x());
  const Eigen::Vector2d a =
      acceleration.linear + acceleration.angular * turned - acceleration.omega_squared * r;
  return -mass_per_length * a.dot(t);
}

}  // namespace

Eigen::VectorXd calc_inertia_load(const MassMoments& moments, const FrameAcceleration& acceleration) {
  return -acceleration.linear.x() * moments.N_x - acceleration.linear.y() * moments.N_y -
         acceleration.angular * (moments.x_N_y - moments.y_N_x + moments.rotary_N) +
         acceleration.omega_squared * (moments.x_N_x + moments.y_N_y);
}

std::vector<AxialForce> calc_axial_forces(const BeamModel& model, const Eigen::VectorXd& displacement,
                                          const FrameAcceleration& acceleration,
                                          const Eigen::Vector2d& origin) {
  check_beam_model(model, "calc_axial_forces");
  if (displacement.size() != 3 * model.mesh.num_nodes()) {
    throw std::invalid_argument(fmt::format("calc_axial_forces: displacement has {} values, expected {}",
                                            displacement.size(), 3 * model.mesh.num_nodes()));
  }
  std::vector<AxialForce> forces;
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const BeamElement element = make_element(model, e);
    if (element.properties.bushing) {
      forces.push_back({.constant = 0.0});
      continue;
    }
    const double length = calc_length(element);
    const Eigen::Vector2d t = (element.second - element.first) / length;
    const double stretch =
        t.dot(displacement.segment<2>(3 * nodes.second) - displacement.segment<2>(3 * nodes.first));
    const double mass_per_length = element.properties.mass_per_length;
    const double p1 = calc_axial_load(acceleration, mass_per_length, element.first - origin, t);
    const double p2 = calc_axial_load(acceleration, mass_per_length, element.second - origin, t);
    const double mean = element.properties.axial_rigidity * stretch / length;
    forces.push_back({.constant = mean + length * (2.0 * p1 + p2) / 6.0,
                      .linear = -length * p1,
                      .quadratic = -0.5 * length * (p2 - p1)});
  }
  return forces;
}

Eigen::Matrix<double, 1, 6> calc_axial_row(const BeamElement& element) {
  Eigen::Matrix<double, 1, 6> row = Eigen::Matrix<double, 1, 6>::Zero();
  if (element.properties.bushing) return row;
  const double length = calc_length(element);
  const Eigen::RowVector2d t = (element.second - element.first).transpose() / length;
  row.segment<2>(3) = element.properties.axial_rigidity / length * t;
  row.head<2>() = -row.segment<2>(3);
  return row;
}

Eigen::MatrixXd calc_axial_forces(const BeamModel& model, const Eigen::MatrixXd& displacements) {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(model.mesh.num_elements(), displacements.cols());
  for (int e = 0; e < model.mesh.num_elements(); ++e) {
    const Mesh::Element& nodes = model.mesh.elements[static_cast<std::size_t>(e)];
    const Eigen::RowVector2d row = calc_axial_row(make_element(model, e)).segment<2>(3);
    // The difference of displacements first: they may be large and nearly equal.
    forces.row(e) =
        row * (displacements.middleRows<2>(3 * nodes.second) - displacements.middleRows<2>(3 * nodes.first));
  }
  return forces;
}

}  // namespace sprung::fem
