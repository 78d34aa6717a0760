#include "dynamics/simulation/make_stepper.h"

#include <utility>

#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"
#include "dynamics/integration/partitioned/partitioned_stepper.h"

namespace sprung::dynamics {

std::unique_ptr<SystemStepper> make_stepper(const Model& model, const SteppingOptions& options,
                                            std::function<void(double time)> on_repartition) {
  if (options.method == SteppingMethod::kGeneralizedAlpha) {
    return std::make_unique<GeneralizedAlphaStepper>(model, options.relative_tolerance,
                                                     options.generalized_alpha);
  }
  return std::make_unique<PartitionedStepper>(model, integrator_options(options), std::move(on_repartition));
}

}  // namespace sprung::dynamics
