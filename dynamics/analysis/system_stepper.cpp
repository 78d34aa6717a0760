#include "dynamics/analysis/system_stepper.h"

#include <utility>

#include "dynamics/analysis/partitioned_stepper.h"

namespace sprung::dynamics {

std::unique_ptr<SystemStepper> make_stepper(const Model& model, const Integrator::Options& options,
                                            std::function<void(double time)> on_repartition) {
  return std::make_unique<PartitionedStepper>(model, options, std::move(on_repartition));
}

}  // namespace sprung::dynamics
