#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/analysis/ode_system.h"

namespace sprung::dynamics {

/// Variable-order, variable-step multistep integration by SUNDIALS CVODE, with location of switches.
class CvodeIntegrator {
 public:
  enum class Method {
    kAdams,  ///< orders 1–12, functional iteration: for smooth motion that is not stiff
    kBdf,    ///< orders 1–5, Newton iteration: for stiff systems
  };
  struct Options {
    Method method = Method::kAdams;
    double relative_tolerance = 1e-6;  ///< > 0, of each component's natural size
  };
  enum class StepResult {
    kStepped,   ///< one step taken
    kSwitched,  ///< a switch function has a zero at time(); `start` has to be called before the next step
    kEnded,     ///< the end time is reached
  };

  CvodeIntegrator(OdeSystem& system, const Options& options);
  ~CvodeIntegrator();
  CvodeIntegrator(CvodeIntegrator&&) = delete;

  /// Starts, or starts anew, at (time, y).
  void start(double time, std::span<const double> y, double end_time);
  /// One step of at most `longest_step`.
  /// @throws support::NumericalError with the time and CVODE's reason
  StepResult step(double longest_step);

  double time() const { return time_; }           ///< end of the last step, or of its part up to a switch
  double step_start() const { return step_start_; }
  std::span<const double> y() const;              ///< at time()
  /// Solution at a time within the last step.
  void interpolate(double time, std::span<double> y) const;
  /// 0-based switches that were found at time(), after kSwitched.
  std::vector<int> switched() const;

  struct Statistics {
    long steps = 0, error_test_failures = 0, iteration_failures = 0, restarts = 0;
  };
  Statistics statistics() const;

 private:
  struct Memory;  // SUNDIALS' handles
  std::unique_ptr<Memory> memory_;
  double time_ = 0.0, step_start_ = 0.0, end_time_ = 0.0;
};

}  // namespace sprung::dynamics
