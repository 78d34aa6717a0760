#pragma once

#include <vector>

#include "dynamics/adaptivity/full_motion.h"
#include "dynamics/adaptivity/missing_acceleration.h"
#include "dynamics/adaptivity/mode_adaptation.h"
#include "dynamics/adaptivity/neglect_record.h"
#include "dynamics/integration/system_stepper.h"

namespace sprung::dynamics {

/// Updates the indicator of modes left out along with a run: at its start, after each switch, at the end of
/// each step and within longer ones (adaptivity, "Indicator").
class ModeMonitor {
 public:
  /// @param start  in coordinates of `options.full`
  ModeMonitor(const AdaptivityOptions& options, const dynamics::State& start);

  ModeAdaptation& modes() { return modes_; }
  const ModeAdaptation& modes() const { return modes_; }
  FullMotion& motion() { return motion_; }  ///< at the last update, or where it has been taken since
  const Eigen::VectorXd& rates() const { return rates_; }  ///< v of the full model at the last update
  WorstNeglect find_worst() const { return record_.find_worst(modes_.indicator()); }
  MissingAcceleration find_missing_acceleration() const { return missing_.find_worst(modes_.indicator()); }

  /// Updates at a time at which the equations are evaluated, up to accelerations.
  /// @param held  where the coordinates of the model that is run are in the full one
  void update(double time, const HeldModes& held, const ConstrainedEquations& equations);

  /// Starts a step at the last update.
  void begin_step();
  /// Updates through the step that a stepper has just made.
  /// @return whether modes were missed in it, where modes can change
  bool follow_step(SystemStepper& stepper, const HeldModes& held);
  /// The largest amplitudes of each mode since `begin_step`.
  const std::vector<ModeAmplitude>& largest() const { return largest_; }
  /// Records the step, which is final.
  void accept_step() { record_.add_step(modes_.indicator(), largest_); }

  /// Stops modes where they are at the last update, by FullMotion::stop, and leaves them out.
  /// @return energy lost by it [J]
  double let_leave(const std::vector<int>& coordinates, const std::vector<int>& branches);

  /// All that an update changes but the largest sizes.
  struct State {
    ModeAdaptation::State modes;
    MissingAccelerationRecord::State missing;
  };
  void get_state(State& state) const;  ///< @param[out] state  its memory is used again
  void set_state(const State& state);  ///< goes back to an earlier instant, with the same active modes

  /// Everything that the run has changed here, at the end of a step, as bytes and back into a monitor with
  /// the same start. An `update` at the same time has to follow.
  void save(support::ByteWriter& bytes) const;
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  void update_largest();
  void update_unbalanced(double time);

  ModeAdaptation modes_;
  FullMotion motion_;
  NeglectRecord record_;
  MissingAccelerationRecord missing_;
  Eigen::VectorXd rates_, unbalanced_;  // unbalanced forces on each mode
  std::vector<ModeAmplitude> largest_;
};

}  // namespace sprung::dynamics
