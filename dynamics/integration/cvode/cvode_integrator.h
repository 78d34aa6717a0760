#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>

#include "dynamics/integration/integrator.h"

namespace sprung::dynamics {

/// Variable-order, variable-step multistep integration by SUNDIALS CVODE, with location of switches.
class CvodeIntegrator final : public Integrator {
 public:
  /// @param options  method kAdams or kBdf
  CvodeIntegrator(OdeSystem& system, const Options& options);
  ~CvodeIntegrator() override;
  CvodeIntegrator(CvodeIntegrator&&) = delete;

  void start(double time, std::span<const double> y, double end_time) override;
  StepResult step(double longest_step) override;
  double time() const override { return time_; }
  std::span<const double> y() const override;
  void interpolate(double time, std::span<double> y) const override;
  Statistics statistics() const override;

 private:
  void calc_switches(double time, std::span<const double> y, Eigen::VectorXd& switches);
  bool locate_touch(double from);

  struct Memory;  // SUNDIALS' handles
  std::unique_ptr<Memory> memory_;
  double time_ = 0.0, end_time_ = 0.0;
};

}  // namespace sprung::dynamics
