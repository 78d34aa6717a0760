#include "dynamics/analysis/integrator.h"

#include "dynamics/analysis/cvode_integrator.h"
#include "dynamics/analysis/exponential_integrator.h"

namespace sprung::dynamics {

std::unique_ptr<Integrator> make_integrator(OdeSystem& system, const Integrator::Options& options) {
  if (options.method == Integrator::Method::kExponential) {
    return std::make_unique<ExponentialIntegrator>(system, options.relative_tolerance);
  }
  return std::make_unique<CvodeIntegrator>(system, options);
}

}  // namespace sprung::dynamics
