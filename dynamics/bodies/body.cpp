#include "dynamics/bodies/body.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace sprung::dynamics {

namespace {

Eigen::MatrixXd select(const Eigen::MatrixXd& matrix, const std::vector<int>& columns) {
  return matrix(columns, columns);
}

void check_stiffening(const reduce::Superelement& superelement, int highest_mode) {
  const int available = superelement.geometric_stiffness ? superelement.geometric_stiffness->num_modes() : 0;
  if (highest_mode <= available) return;
  throw std::invalid_argument(fmt::format(
      "make_flexible_body: superelement '{}' has the geometric stiffness of {} modes, got mode {}",
      superelement.name, available, highest_mode));
}

}  // namespace

Body make_rigid_body(const std::string& name, double mass, double inertia) {
  if (!(mass >= 0.0))
    throw std::invalid_argument(fmt::format("make_rigid_body: mass must be ≥ 0 kg, got {}", mass));
  if (!(inertia >= 0.0)) {
    throw std::invalid_argument(fmt::format("make_rigid_body: inertia must be ≥ 0 kg·m², got {}", inertia));
  }
  Body body;
  body.name = name;
  body.mass = mass;
  body.second_moment = inertia;
  body.P.resize(2, 0);
  return body;
}

Body make_flexible_body(const std::string& name, const reduce::Superelement& superelement,
                        const std::vector<int>& mode_numbers, Stiffening stiffening) {
  std::vector<int> columns;
  for (const int number : mode_numbers) {
    if (number < 1 || number > superelement.num_modes() ||
        (!columns.empty() && number - 1 <= columns.back())) {
      throw std::invalid_argument(
          fmt::format("make_flexible_body: mode numbers must ascend from 1 to {}, got {}",
                      superelement.num_modes(), number));
    }
    columns.push_back(number - 1);
  }
  const reduce::InertiaInvariants& inertia = superelement.inertia;
  Body body;
  body.name = name;
  body.mode_numbers = mode_numbers;
  body.num_available_modes = superelement.num_modes();
  body.mass = inertia.mass;
  body.first_moment = inertia.first_moment;
  body.second_moment = inertia.second_moment;
  body.P = inertia.P(Eigen::all, columns);
  body.c = inertia.c(columns);
  body.d = inertia.d(columns);
  body.M_ff = select(inertia.M_ff, columns);
  body.modal_mass = superelement.has_free_basis()
                        ? Eigen::VectorXd::Ones(static_cast<Eigen::Index>(columns.size()))
                        : Eigen::VectorXd(body.M_ff.diagonal());
  body.M_tt = select(inertia.phi_x_phi_x, columns) + select(inertia.phi_y_phi_y, columns);
  body.B = select(inertia.B, columns);
  body.stiffness = select(superelement.stiffness, columns);
  body.damping = select(superelement.damping, columns);
  if (stiffening == Stiffening::kOn && !columns.empty()) {
    check_stiffening(superelement, mode_numbers.back());
    body.stiffening = make_body_stiffening(superelement, columns);
  }
  body.mode_scale.resize(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    double largest = 0.0;
    for (int node = 0; node < superelement.num_nodes(); ++node) {
      largest = std::max(largest, superelement.shapes.block<2, 1>(3 * node, columns[k]).norm());
    }
    body.mode_scale[static_cast<Eigen::Index>(k)] = largest;
  }
  return body;
}

}  // namespace sprung::dynamics
