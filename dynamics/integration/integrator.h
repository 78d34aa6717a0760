#pragma once

#include <Eigen/Core>
#include <span>

#include "dynamics/integration/ode_system.h"

namespace sprung::dynamics {

/// Integration of an OdeSystem step by step, with location of the zeros of its switch functions.
class Integrator {
 public:
  enum class Method {
    kAdams,        ///< CVODE, orders 1–12, functional iteration: smooth motion that is not stiff
    kBdf,          ///< CVODE, orders 1–5, Newton iteration: stiff systems
    kExponential,  ///< exponential collocation: linear vibration exactly, the rest by a quadrature of order 6
  };
  struct Options {
    Method method = Method::kExponential;
    double relative_tolerance = 1e-6;  ///< > 0, of each component's natural size
  };
  enum class StepResult {
    kStepped,   ///< one step taken
    kSwitched,  ///< a switch function has a zero at time(); `start` has to be called before the next step
    kEnded,     ///< the end time is reached
  };
  struct Statistics {
    long steps = 0, error_test_failures = 0, iteration_failures = 0, restarts = 0;
  };

  virtual ~Integrator() = default;

  /// Starts, or restarts, at (time, y).
  virtual void start(double time, std::span<const double> y, double end_time) = 0;
  /// One step of at most `longest_step`.
  /// @throws support::NumericalError with the time and the reason
  virtual StepResult step(double longest_step) = 0;
  /// Largest part of a step in which forces are not evaluated.
  virtual double largest_gap() const { return 1.0; }

  virtual double time() const = 0;                ///< end of the last step, or of its part up to a switch
  virtual std::span<const double> y() const = 0;  ///< at time()
  /// Solution at a time within the last step.
  virtual void interpolate(double time, std::span<double> y) const = 0;
  virtual Statistics statistics() const = 0;
  /// Estimated error of the accelerations by vibration at a time within the last step.
  /// @param[out] error  of each freedom   @return false for methods that have no estimate
  virtual bool estimate_acceleration_error(double /*time*/, Eigen::VectorXd& /*error*/) const {
    return false;
  }
  /// The small motion in use, for methods that treat it separately; null for others, and where another one
  /// will be asked for with the next step.
  virtual const SmallMotion* small_motion() const { return nullptr; }
};

}  // namespace sprung::dynamics
