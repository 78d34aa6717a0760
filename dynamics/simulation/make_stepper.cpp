#include "dynamics/simulation/make_stepper.h"

#include <utility>

#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"
#include "dynamics/integration/partitioned/partitioned_stepper.h"

namespace sprung::dynamics {

std::unique_ptr<SystemStepper> make_stepper(const Model& model, const SteppingOptions& options,
                                            std::function<void(double time)> on_repartition) {
  const double tolerance = options.relative_tolerance;
  if (const auto method = find_integrator(options.method)) {
    const Integrator::Options integrator{.method = *method, .relative_tolerance = tolerance};
    return std::make_unique<PartitionedStepper>(model, integrator, std::move(on_repartition));
  }
  return std::make_unique<GeneralizedAlphaStepper>(model, tolerance, options.generalized_alpha);
}

}  // namespace sprung::dynamics
