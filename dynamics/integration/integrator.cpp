#include "dynamics/integration/integrator.h"

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

}  // namespace sprung::dynamics
