#include "dynamics/output/resting_forces.h"

namespace sprung::dynamics {

RestingForces::RestingForces(const Model& model, const Eigen::VectorXd& q) : terms_(model) {
  terms_.update_positions(0.0, q);
  terms_.update_velocities(Eigen::VectorXd::Zero(model.num_coordinates));
  branches_ = terms_.find_branches();
}

std::vector<double> RestingForces::calc_channels(std::size_t force_index) const {
  const Model& model = terms_.model();
  const ForceElement& force = *model.forces[force_index];
  std::vector<double> values(force.channels().size());
  force.calc_channels(terms_.instant_of(force_index), model.branches_of(force_index, branches_), values);
  return values;
}

}  // namespace sprung::dynamics
