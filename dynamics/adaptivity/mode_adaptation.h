#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "dynamics/adaptivity/missing_motion.h"
#include "dynamics/adaptivity/mode_indicator.h"

namespace sprung::dynamics {

/// When modes join and leave. Shares are of the largest deflection and acceleration of the asked points.
struct AdaptivityThresholds {
  double recall = 8e-2;  ///< share of all modes left out together at which some of them join
  double drop = 2e-3;    ///< share below which a mode may leave, < recall
  /// Shortest time below `drop` before a mode leaves, and from one change to a leaving; also how far the run
  /// looks ahead before modes join [s]
  double residence = 0.05;
};

/// How modes join and leave during a run.
struct AdaptivityOptions {
  const Model* full = nullptr;  ///< with every mode that is available; has to outlive the run
  /// Of `full` about the start, where it is known; needed until the run has begun.
  const LinearisedSystem* linearised = nullptr;
  std::vector<bool> active;  ///< at the start, for each coordinate of `full`
  std::vector<int> points;   ///< markers whose motion is asked for
  bool continues = false;    ///< whether the start is the end of an earlier run
  /// How the run starts beside the full model, where modes do not change. Else both start alike.
  MissingStart missing;
  double judged_from = 0.0,
         judged_to = std::numeric_limits<double>::infinity();  ///< where its error counts [s]
  bool changes = true;  ///< false: modes stay as they are, the indicator alone is followed
  AdaptivityThresholds thresholds;
};

/// Decides which modes are active: those left out join when the indicator passes the recall threshold, active
/// ones may leave when their effect stays below the drop threshold (adaptivity, "Joining", "Leaving").
class ModeAdaptation {
 public:
  /// @param start  in coordinates of `options.full`; what is not active is held at its values
  ModeAdaptation(const AdaptivityOptions& options, const dynamics::State& start);

  const AdaptivityOptions& options() const { return options_; }
  const ModeIndicator& indicator() const { return indicator_; }
  const std::vector<bool>& active() const { return active_; }  ///< for each coordinate of the full model
  int num_active_modes() const;

  /// Continues to the next instant, as ModeIndicator::update.
  void update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);

  /// Whether the modes left out have passed the recall threshold at the last update.
  bool misses_any() const;
  /// Modal coordinates that have to join for the largest amplitudes of a step.
  /// @param largest  of each mode
  std::vector<int> find_missed(const std::vector<ModeAmplitude>& largest) const;
  /// Modal coordinates that may leave, once their rate is zero.
  std::vector<int> find_idle() const;
  /// Those of the idle ones that can be stopped at once where they are, so that they leave no more ringing
  /// than modes that join may.
  /// @param v  in coordinates of the full model
  std::vector<int> find_stoppable(const std::vector<int>& idle, const Eigen::VectorXd& v) const;

  double frequency_of(int coordinate) const;   ///< [Hz], everything else giving way
  double held_force_of(int coordinate) const;  ///< as ModeIndicator::held_force [N/√kg]
  ModeShare share_of(int coordinate, const std::vector<ModeAmplitude>& largest) const;
  void activate(const std::vector<int>& coordinates);
  /// Time within which the forces that held modes fade, after `activate`: they leave no more than a small
  /// part of the recall threshold ringing, and are over before the modes may leave [s].
  double calc_fading_time(const std::vector<int>& coordinates, const std::vector<double>& forces) const;
  void deactivate(const std::vector<int>& coordinates);

  /// The motion of an active mode since its share was last above the drop threshold.
  struct Window {
    double since = 0.0;  ///< [s]
    double low = 0.0, high = 0.0, largest_acceleration = 0.0;
    double share = 0.0;  ///< of range and acceleration
  };
  /// All that an update changes but the largest sizes.
  struct State {
    ModeIndicator::State indicator;
    std::vector<std::optional<Window>> windows;  // of each mode
  };
  /// @param[out] state  its memory is used again
  void get_state(State& state) const;
  /// Goes back to an earlier instant, with the same active modes.
  void set_state(const State& state);

  /// All that has changed since the start, as bytes and back into an object with the same start.
  void save(support::ByteWriter& bytes) const;
  void restore(support::ByteReader& bytes);  ///< @throws support::DamagedBytes

 private:
  template <class Bytes, class Adaptation>
  static void transfer(Bytes& bytes, Adaptation& adaptation);

  AdaptivityOptions options_;
  ModeIndicator indicator_;
  std::vector<bool> active_;
  std::vector<std::optional<Window>> windows_;  // of each mode
  double last_change_;
};

}  // namespace sprung::dynamics
