#pragma once

#include <span>

namespace sprung::dynamics {

/// ẏ = f(t, y) with switch functions, as an integrator sees it.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;
  virtual int size() const = 0;
  /// @return false where f cannot be evaluated; the integrator then tries a shorter step
  virtual bool calc_derivative(double time, std::span<const double> y, std::span<double> y_dot) = 0;
  virtual int num_switches() const = 0;
  virtual bool calc_switches(double time, std::span<const double> y, std::span<double> values) = 0;
  /// Natural size of each component: the relative tolerance times this is the error allowed in a step.
  virtual void calc_error_scales(std::span<const double> y, std::span<double> scales) const = 0;
};

}  // namespace sprung::dynamics
