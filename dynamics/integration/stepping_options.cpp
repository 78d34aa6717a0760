#include "dynamics/integration/stepping_options.h"

namespace sprung::dynamics {

SteppingMethod default_method(int num_freedoms, bool has_modes) {
  constexpr int kMost = 100, kMostWithModes = 300;
  return num_freedoms > 0 && num_freedoms <= (has_modes ? kMostWithModes : kMost)
             ? SteppingMethod::kExponential
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
