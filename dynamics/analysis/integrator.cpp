#include "dynamics/analysis/integrator.h"

#include <stdexcept>

#include "dynamics/analysis/cvode_integrator.h"
#include "dynamics/analysis/exponential_integrator.h"

namespace sprung::dynamics {

std::string_view method_name(Integrator::Method method) {
  switch (method) {
    case Integrator::Method::kAdams:
      return "adams";
    case Integrator::Method::kBdf:
      return "bdf";
    case Integrator::Method::kExponential:
      return "exponential";
    case Integrator::Method::kGeneralizedAlpha:
      return "generalized-alpha";
  }
  return "";
}

Integrator::Method default_method(int num_freedoms) {
  constexpr int kMostForFullMatrices = 100;
  return num_freedoms > 0 && num_freedoms <= kMostForFullMatrices ? Integrator::Method::kExponential
                                                                  : Integrator::Method::kAdams;
}

std::unique_ptr<Integrator> make_integrator(OdeSystem& system, const Integrator::Options& options) {
  if (options.method == Integrator::Method::kExponential) {
    if (system.num_freedoms() == 0) {  // all motion is prescribed, only the energies are integrated
      const Integrator::Options adams{.method = Integrator::Method::kAdams,
                                      .relative_tolerance = options.relative_tolerance};
      return std::make_unique<CvodeIntegrator>(system, adams);
    }
    return std::make_unique<ExponentialIntegrator>(system, options.relative_tolerance);
  }
  if (options.method == Integrator::Method::kGeneralizedAlpha) {
    throw std::invalid_argument("make_integrator: generalized-alpha is a stepper of the whole system");
  }
  return std::make_unique<CvodeIntegrator>(system, options);
}

}  // namespace sprung::dynamics
