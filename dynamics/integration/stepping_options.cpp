#include "dynamics/integration/stepping_options.h"

#include <stdexcept>

namespace sprung::dynamics {

SteppingMethod default_method(int num_freedoms) {
  constexpr int kMostForFullMatrices = 100;
  return num_freedoms > 0 && num_freedoms <= kMostForFullMatrices ? SteppingMethod::kExponential
                                                                  : SteppingMethod::kAdams;
}

Integrator::Options integrator_options(const SteppingOptions& options) {
  const double tolerance = options.relative_tolerance;
  switch (options.method) {
    case SteppingMethod::kExponential:
      return {.method = Integrator::Method::kExponential, .relative_tolerance = tolerance};
    case SteppingMethod::kAdams:
      return {.method = Integrator::Method::kAdams, .relative_tolerance = tolerance};
    case SteppingMethod::kBdf:
      return {.method = Integrator::Method::kBdf, .relative_tolerance = tolerance};
    case SteppingMethod::kGeneralizedAlpha:
      break;
  }
  throw std::invalid_argument("integrator_options: generalized-alpha integrates the constrained system");
}

}  // namespace sprung::dynamics
