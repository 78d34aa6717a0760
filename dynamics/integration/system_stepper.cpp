#include "dynamics/integration/system_stepper.h"

#include <algorithm>

namespace sprung::dynamics {

SystemStepper::Statistics& SystemStepper::Statistics::operator+=(const Statistics& later) {
  integrator.steps += later.integrator.steps;
  integrator.error_test_failures += later.integrator.error_test_failures;
  integrator.iteration_failures += later.integrator.iteration_failures;
  integrator.restarts += later.integrator.restarts;
  evaluations += later.evaluations;
  repartitions += later.repartitions;
  velocity_violation = std::max(velocity_violation, later.velocity_violation);
  return *this;
}

}  // namespace sprung::dynamics
