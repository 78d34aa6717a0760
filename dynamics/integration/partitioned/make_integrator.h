#pragma once

#include <memory>

#include "dynamics/integration/integrator.h"

namespace sprung::dynamics {

/// @param system  has to outlive the integrator
/// @return for the exponential method without a freedom, which has no vibration to know, Adams
std::unique_ptr<Integrator> make_integrator(OdeSystem& system, const Integrator::Options& options);

}  // namespace sprung::dynamics
