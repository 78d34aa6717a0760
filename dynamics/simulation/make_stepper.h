#pragma once

#include <functional>
#include <memory>

#include "dynamics/integration/stepping_options.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

/// @param model           has to outlive the stepper
/// @param on_repartition  called with the time when other independent coordinates have been chosen
std::unique_ptr<SystemStepper> make_stepper(const Model& model, const SteppingOptions& options,
                                            std::function<void(double time)> on_repartition);

}  // namespace sprung::dynamics
