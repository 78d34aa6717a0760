#include "dynamics/integration/stepping_options.h"

namespace sprung::dynamics {

SteppingMethod default_method(int num_freedoms) {
  constexpr int kMostForFullMatrices = 100;
  return num_freedoms > 0 && num_freedoms <= kMostForFullMatrices ? SteppingMethod::kExponential
                                                                  : SteppingMethod::kAdams;
}

std::optional<Integrator::Method> find_integrator(SteppingMethod method) {
  switch (method) {
    case SteppingMethod::kExponential:
      return Integrator::Method::kExponential;
    case SteppingMethod::kAdams:
      return Integrator::Method::kAdams;
    case SteppingMethod::kBdf:
      return Integrator::Method::kBdf;
    case SteppingMethod::kGeneralizedAlpha:
      break;
  }
  return std::nullopt;
}

}  // namespace sprung::dynamics
