#include "dynamics/system/fading_force.h"

#include <cmath>
#include <numbers>

namespace sprung::dynamics {

double FadingForce::value(double time) const {
  const double s = (time - start) / duration;
  return s >= 1.0 ? 0.0 : s <= 0.0 ? force : 0.5 * force * (1.0 + std::cos(std::numbers::pi * s));
}

}  // namespace sprung::dynamics
