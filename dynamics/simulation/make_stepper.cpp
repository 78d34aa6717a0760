#include "dynamics/simulation/make_stepper.h"

#include <optional>
#include <utility>

#include "dynamics/integration/generalized_alpha/generalized_alpha_stepper.h"
#include "dynamics/integration/partitioned/partitioned_stepper.h"

namespace sprung::dynamics {

std::unique_ptr<SystemStepper> make_stepper(const Model& model, const SteppingOptions& options,
                                            std::function<void(double time)> on_repartition) {
  const double tolerance = options.relative_tolerance;
  std::optional<Integrator::Method> method = find_integrator(options.method);
  // Without a freedom only the energies are integrated. Accelerations that the constraints alone determine
  // are no error of a generalized-α step, and steps of changing length would make them grow.
  if (!method && model.num_freedoms() == 0 && !(options.generalized_alpha.fixed_step > 0.0))
    method = Integrator::Method::kAdams;
  if (method) {
    const Integrator::Options integrator{.method = *method, .relative_tolerance = tolerance};
    return std::make_unique<PartitionedStepper>(model, integrator, std::move(on_repartition));
  }
  return std::make_unique<GeneralizedAlphaStepper>(model, tolerance, options.generalized_alpha);
}

}  // namespace sprung::dynamics
