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

}  // namespace sprung::dynamics
