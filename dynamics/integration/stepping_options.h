#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "dynamics/integration/integrator.h"

namespace sprung::dynamics {

/// Every method by which a vehicle can be run: the integrators of ordinary differential equations, and
/// generalized-α.
enum class SteppingMethod { kExponential, kGeneralizedAlpha, kAdams, kBdf };

/// The names of the methods as in run files, in the order of SteppingMethod.
inline constexpr std::array<std::string_view, 4> kMethodNames = {"exponential", "generalized-alpha", "adams",
                                                                 "bdf"};
inline std::string_view method_name(SteppingMethod method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}

/// Options of generalized-α alone.
struct GeneralizedAlphaOptions {
  double spectral_radius = 0.8;  ///< 0 to 1, at infinite frequency
  /// All steps are equal and at most this long, whatever their error; 0: the error decides [s].
  double fixed_step = 0.0;
};

struct SteppingOptions {
  SteppingMethod method = SteppingMethod::kExponential;
  double relative_tolerance = 1e-6;  ///< > 0, of each component's natural size
  GeneralizedAlphaOptions generalized_alpha = {};
};

/// The default method: exponential; Adams without freedoms, and for so many that the full 2f×2f matrices of
/// the exponential method cost more than the equations. With modes these are more, because Adams' method
/// follows the highest one.
SteppingMethod default_method(int num_freedoms, bool has_modes);

/// The integrator of ordinary differential equations that a method is; none for generalized-α.
std::optional<Integrator::Method> find_integrator(SteppingMethod method);

}  // namespace sprung::dynamics
