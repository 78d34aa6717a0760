#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_monitor.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

/// Steps a system whose modes join and leave, by a stepper of its own for each set of modes. A step that
/// missed a mode is taken back and made again with it (adaptivity, "Joining").
class AdaptiveStepper final : public SystemStepper {
 public:
  struct Listener {
    std::function<void(double time)> on_repartition;
    /// @param coordinate  of the full model
    std::function<void(double time, int coordinate, const std::string& what)> on_change;
  };
  /// @param monitor  of the full model, in whose coordinates states are given; its options have
  ///                 `changes` = true; has to outlive this
  AdaptiveStepper(const SteppingOptions& integrator, ModeMonitor& monitor, Listener listener);

  std::optional<KnownMotion> small_motion() const override { return segment_->stepper->small_motion(); }
  void continue_small_motion(const KnownMotion& known) override {
    segment_->stepper->continue_small_motion(known);
  }
  void start(const State& state) override;
  void resume(double time, double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return rest_ ? *rest_ : segment_->stepper->time(); }
  double calc_longest_step() const override { return segment_->stepper->calc_longest_step(); }
  void evaluate(double time, Level level) override { segment_->stepper->evaluate(time, level); }
  Observation observation() override;
  const ConstrainedEquations& equations() const override { return segment_->stepper->equations(); }
  const Eigen::VectorXd* estimate_acceleration_error() override {
    return segment_->stepper->estimate_acceleration_error();
  }
  EnergyFlow energy_flow() const override;
  SmoothPiece& piece() override { return segment_->stepper->piece(); }
  Statistics statistics() const override;

  long num_changes() const { return num_changes_; }
  double active_mode_time() const;  ///< Σ active modes × time [s]
  /// Whether the last step was cut at an instant at which modes leave with the next one.
  bool ends_at_rest() const { return rest_.has_value(); }

 private:
  // A part of the run with one set of modes.
  struct Segment {
    HeldModes held;
    double start = 0.0;                      // [s]
    double held_strain = 0.0;                // [J]
    int num_modes = 0;                       // active
    std::unique_ptr<SystemStepper> stepper;  // of held.model: destroyed before it
  };
  // The start of the last step, to which the run can go back. Motion, energies and branches are set when it
  // does.
  struct StepStart {
    double time = 0.0;
    ModeMonitor::State monitor;
    Eigen::VectorXd rates;  // as ModeMonitor::rates
    Eigen::VectorXd q, v;   // of the full model
    EnergyFlow flow;
    std::vector<int> branches;
  };

  const ModeAdaptation& modes() const { return monitor_.modes(); }
  std::unique_ptr<Segment> make_segment(double time, const std::vector<int>& branches) const;
  void continue_with_active_modes(double time, const EnergyFlow& flow, const std::vector<int>& branches);
  std::optional<Integrator::StepResult> attempt_step(double longest_step);
  void explore_without_missed_modes(Integrator::StepResult result);
  void go_back_to_start();
  void repeat_with_missed_modes();
  void let_join(const std::vector<int>& missed);
  std::optional<double> find_rest_of_idle_modes();
  std::optional<double> find_rest(int coordinate);
  void let_idle_modes_leave();
  double rate_of(int coordinate) const;

  SteppingOptions integrator_;
  ModeMonitor& monitor_;
  Listener listener_;

  std::unique_ptr<Segment> segment_;
  EnergyFlow flow_before_;  // of the segments before
  Statistics work_before_;
  double end_time_ = 0.0;
  double explored_until_ = -std::numeric_limits<double>::infinity();

  StepStart step_start_;
  std::vector<int> idle_;       // modal coordinates that may leave
  std::optional<double> rest_;  // where they do, in the last step, which ends there [s]

  long num_changes_ = 0;
  double active_time_ = 0.0;  // Σ active modes × time of the segments before
};

}  // namespace sprung::dynamics
