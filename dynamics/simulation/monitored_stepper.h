#pragma once

#include <memory>
#include <optional>

#include "dynamics/adaptivity/mode_monitor.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

/// Steps a system with a fixed set of modes by another stepper, with the indicator of the modes left out
/// beside it.
class MonitoredStepper final : public SystemStepper {
 public:
  /// @param stepper  of `model`
  /// @param model    that is run
  /// @param monitor  its options have `changes` = false; has to outlive this
  MonitoredStepper(std::unique_ptr<SystemStepper> stepper, const Model& model, ModeMonitor& monitor);

  std::optional<KnownMotion> small_motion() const override { return stepper_->small_motion(); }
  void continue_small_motion(const KnownMotion& known) override { stepper_->continue_small_motion(known); }
  void start(const State& state) override;
  void resume(double time, double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return stepper_->time(); }
  double calc_longest_step() const override { return stepper_->calc_longest_step(); }
  void evaluate(double time, Level level) override { stepper_->evaluate(time, level); }
  Observation observation() override { return stepper_->observation(); }
  const ConstrainedEquations& equations() const override { return stepper_->equations(); }
  const Eigen::VectorXd* estimate_acceleration_error() override {
    return stepper_->estimate_acceleration_error();
  }
  EnergyFlow energy_flow() const override { return stepper_->energy_flow(); }
  SmoothPiece& piece() override { return stepper_->piece(); }
  Statistics statistics() const override { return stepper_->statistics(); }

 private:
  std::unique_ptr<SystemStepper> stepper_;
  HeldModes held_;  // places of the coordinates in the full model alone
  ModeMonitor& monitor_;
};

}  // namespace sprung::dynamics
