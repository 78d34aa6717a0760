#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/full_motion.h"
#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/integration/stepping_options.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

/// Steps a system whose modes join and leave, by a stepper of its own for each set of modes; or a fixed set
/// with the indicator of those left out beside it. A step that missed a mode is taken back and made again
/// with it (adaptivity, "Joining").
class AdaptiveStepper final : public SystemStepper {
 public:
  struct Listener {
    std::function<void(double time)> on_repartition;
    /// @param coordinate  of the full model
    std::function<void(double time, int coordinate, const std::string& what)> on_change;
  };
  /// @param model  that the run was given: the full one where modes change; has to outlive this
  AdaptiveStepper(const Model& model, const SteppingOptions& integrator, const AdaptivityOptions& options,
                  Listener listener);

  void start(const State& state) override;
  void resume(double time, double end_time) override;
  Integrator::StepResult step(double longest_step) override;
  double time() const override { return rest_ ? *rest_ : leg_->stepper->time(); }
  double calc_longest_step() const override { return leg_->stepper->calc_longest_step(); }
  void evaluate(double time, Level level) override;
  Observation observation() override;
  const ConstrainedEquations& equations() const override { return leg_->stepper->equations(); }
  EnergyFlow energy_flow() const override;
  SmoothPiece& piece() override { return leg_->stepper->piece(); }
  Statistics statistics() const override;

  const ModeAdaptation& modes() const { return *modes_; }
  long num_changes() const { return num_changes_; }
  double mean_active_modes() const;  ///< over time

 private:
  // A stretch of the run with one set of modes.
  struct Leg {
    HeldModes held;
    double start = 0.0;                      // [s]
    double held_strain = 0.0;                // [J]
    int num_modes = 0;                       // active
    std::unique_ptr<SystemStepper> stepper;  // of held.model where modes change: gone before it
  };

  std::unique_ptr<Leg> make_leg(HeldModes held, double time, const std::vector<int>& branches) const;
  void go_on(HeldModes held, double time, const EnergyFlow& flow, const std::vector<int>& branches);
  void watch(double time);
  bool follow_step();
  void take_back(Integrator::StepResult result);
  void let_join(const std::vector<int>& missed);
  void look_ahead(Integrator::StepResult result, double until);
  std::optional<double> find_rest();
  std::optional<double> find_rest_of(int coordinate);
  void let_modes_go();
  double rate_of(int coordinate) const;

  const Model* model_;
  SteppingOptions integrator_;
  AdaptivityOptions options_;
  Listener listener_;

  std::optional<ModeAdaptation> modes_;
  std::optional<FullMotion> motion_;
  std::unique_ptr<Leg> leg_;
  EnergyFlow flow_before_;  // of the legs before
  Statistics work_before_;
  double end_time_ = 0.0, watched_time_ = 0.0;
  double looked_until_ = -std::numeric_limits<double>::infinity();  // how far the run has been looked ahead

  // The last step: its start, the indicator there.
  double step_start_ = 0.0;
  Eigen::VectorXd rates_before_, rates_;  // there, and at the last update of the indicator
  ModeAdaptation::Memory memory_;
  ModeAdaptation::LeftOut largest_;  // in it
  std::vector<int> idle_;            // modes that may leave
  std::optional<double> rest_;       // where they do, in the last step: it ends there [s]

  long num_changes_ = 0;
  double start_time_ = 0.0;
  double active_time_ = 0.0;  // Σ active modes × time of the legs before
};

}  // namespace sprung::dynamics
