#include "dynamics/integration/partitioned/make_integrator.h"

#include "dynamics/integration/cvode/cvode_integrator.h"
#include "dynamics/integration/exponential/exponential_integrator.h"

namespace sprung::dynamics {

std::unique_ptr<Integrator> make_integrator(OdeSystem& system, const Integrator::Options& options) {
  if (options.method == Integrator::Method::kExponential) {
    if (system.num_freedoms() == 0) {  // all motion is prescribed, only the energies are integrated
      const Integrator::Options adams{.method = Integrator::Method::kAdams,
                                      .relative_tolerance = options.relative_tolerance};
      return std::make_unique<CvodeIntegrator>(system, adams);
    }
    return std::make_unique<ExponentialIntegrator>(system, options.relative_tolerance);
  }
  return std::make_unique<CvodeIntegrator>(system, options);
}

}  // namespace sprung::dynamics
