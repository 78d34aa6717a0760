#include "dynamics/section_loads/resting_sections.h"

#include <vector>

#include "dynamics/system/constrained_equations.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

RestingSections calc_resting_sections(const Vehicle& vehicle, const Model& model,
                                      const Equilibrium& equilibrium, VehicleSections& sections) {
  RestingSections resting{SectionStatistics(sections), make_body_bending(vehicle, model, sections)};
  if (sections.bodies().empty()) return resting;
  ConstrainedEquations equations(model, SystemTerms::Markers::kAll);
  const Eigen::VectorXd v = equilibrium.motion.calc_velocity(model, equilibrium.q);
  SystemTerms& terms = equations.terms();
  terms.update_positions(0.0, equilibrium.q);
  terms.update_jacobian();
  terms.update_velocities(v);
  const std::vector<int> branches = terms.find_branches();
  if (!equations.update_accelerations(branches)) {
    throw support::NumericalError(
        "the accelerations at the equilibrium cannot be computed: constraints depend on each other");
  }
  sections.update(terms, equations.multipliers(), equilibrium.q, v, equations.v_dot());
  resting.loads.add(0.0);
  add_to_bending(sections, 0.0, equilibrium.q, resting.bending);
  return resting;
}

}  // namespace sprung::dynamics
