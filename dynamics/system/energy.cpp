#include "dynamics/system/energy.h"

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
    auto momentum = products.head(body.num_coordinates());
    momentum.noalias() = terms.mass(b) * v;
    energy.kinetic += 0.5 * v.dot(momentum);
    if (body.num_modes() > 0) {
      auto elastic = products.head(body.num_modes());
      elastic.noalias() = body.stiffness * eta;
      energy.strain += 0.5 * eta.dot(elastic);
    }
    const Eigen::Vector2d moment = FrameRotation::from_angle(q[2]) * calc_first_moment(body, eta);
    energy.gravity -= model.gravity.dot(body.mass * q.head<2>() + moment);
  }
  for (std::size_t f = 0; f < model.forces.size(); ++f) {
    const ForceElement& force = *model.forces[f];
    energy.spring += force.calc_stored_energy(terms.instant_of(f), model.branches_of(f, branches));
  }
  return energy;
}

}  // namespace sprung::dynamics
