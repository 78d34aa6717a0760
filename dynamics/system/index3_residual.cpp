#include "dynamics/system/index3_residual.h"

namespace sprung::dynamics {

Index3Residual::Index3Residual(const Model& model)
    : terms_(model, SystemTerms::Markers::kActing),
      force_(Eigen::VectorXd::Zero(model.num_coordinates)),
      phi_(Eigen::VectorXd::Zero(model.num_constraints)) {}

void Index3Residual::update(const ConstrainedMotion& motion, std::span<const int> branches) {
  ++num_updates_;
  terms_.update_positions(motion.time, motion.q);
  terms_.update_jacobian();
  terms_.update_mass();
  terms_.update_velocities(motion.v);
  terms_.update_forces(branches);
  terms_.calc_residual(phi_);
  force_ = -terms_.forces();
  terms_.jacobian().add_transposed_product(motion.lambda, force_);
  const Model& model = terms_.model();
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int first = model.bodies[b].first_coordinate, size = model.bodies[b].num_coordinates();
    force_.segment(first, size).noalias() += terms_.mass(b) * motion.v_dot.segment(first, size);
  }
  force_.tail(model.num_states()) += motion.v_dot.tail(model.num_states());
}

}  // namespace sprung::dynamics
