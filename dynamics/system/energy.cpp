#include "dynamics/system/energy.h"

#include "tools/support/dense/wide_product.h"

namespace sprung::dynamics {

Energy calc_energy(const SystemTerms& terms, std::span<const int> branches) {
  const Model& model = terms.model();
  Energy energy;
  Eigen::VectorXd products(model.num_coordinates);  // allocated once, as every output needs the energy
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const auto q = terms.q().segment(body.first_coordinate, body.num_coordinates());
    const auto v = terms.v().segment(body.first_coordinate, body.num_coordinates());
    const auto eta = q.tail(body.num_modes());
    support::multiply(terms.mass(b), v.data(), products.data());
    energy.kinetic += 0.5 * v.dot(products.head(v.size()));
    if (body.num_modes() > 0) {
      support::multiply(body.stiffness, eta.data(), products.data());
      energy.strain += 0.5 * eta.dot(products.head(eta.size()));
    }
    const Eigen::Vector2d moment = terms.rotation(b) * calc_first_moment(body, eta);
    energy.gravity -= model.gravity.dot(body.mass * q.head<2>() + moment);
  }
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    energy.spring += force.calc_stored_energy(terms.instant_of(f), model.branches_of(f, branches));
  }
  return energy;
}

void calc_kinetic_parts(const SystemTerms& terms, Eigen::VectorXd& parts) {
  const std::vector<Body>& bodies = terms.model().bodies;
  const auto part_of = [&](std::size_t b) { return parts.segment<3>(2 + 3 * static_cast<Eigen::Index>(b)); };
  parts.setZero(2 + 3 * static_cast<Eigen::Index>(bodies.size()));
  Eigen::VectorXd product(terms.model().num_coordinates);
  Eigen::Vector2d momentum = Eigen::Vector2d::Zero();
  double mass = 0.0;
  // At first with the momentum of each body in the place of its parts along x and y.
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto v = terms.v().segment(bodies[b].first_coordinate, bodies[b].num_coordinates());
    support::multiply(terms.mass(b), v.data(), product.data());
    part_of(b) << product.head<2>(), 0.5 * v.dot(product.head(v.size()));
    momentum += product.head<2>();
    mass += bodies[b].mass;
  }
  if (!(mass > 0.0)) return;
  const Eigen::Vector2d common = momentum / mass;
  parts.head<2>() = 0.5 * mass * common.array().square();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!(bodies[b].mass > 0.0)) continue;
    const Eigen::Vector2d velocity = part_of(b).head<2>() / bodies[b].mass;
    part_of(b)[2] -= 0.5 * bodies[b].mass * velocity.squaredNorm();
    part_of(b).head<2>() = 0.5 * bodies[b].mass * (velocity - common).array().square();
  }
}

}  // namespace sprung::dynamics
