#include "dynamics/analysis/system_stepper.h"

#include <algorithm>
#include <utility>

#include "dynamics/analysis/generalized_alpha_stepper.h"
#include "dynamics/analysis/partitioned_stepper.h"

namespace sprung::dynamics {

SystemStepper::Statistics& SystemStepper::Statistics::operator+=(const Statistics& later) {
  integrator.steps += later.integrator.steps;
  integrator.error_test_failures += later.integrator.error_test_failures;
  integrator.iteration_failures += later.integrator.iteration_failures;
  integrator.restarts += later.integrator.restarts;
  integrator.bends += later.integrator.bends;
  evaluations += later.evaluations;
  repartitions += later.repartitions;
  velocity_violation = std::max(velocity_violation, later.velocity_violation);
  return *this;
}

std::unique_ptr<SystemStepper> make_stepper(const Model& model, const Integrator::Options& options,
                                            std::function<void(double time)> on_repartition) {
  if (options.method == Integrator::Method::kGeneralizedAlpha) {
    return std::make_unique<GeneralizedAlphaStepper>(model, options);
  }
  return std::make_unique<PartitionedStepper>(model, options, std::move(on_repartition));
}

}  // namespace sprung::dynamics
