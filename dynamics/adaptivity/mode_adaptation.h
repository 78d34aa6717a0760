#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dynamics/adaptivity/mode_indicator.h"
#include "dynamics/system/held_modes.h"

namespace sprung::dynamics {

/// When modes join and leave. Shares are of the largest deflection and acceleration of the asked points.
struct AdaptivityThresholds {
  double recall = 8e-2;  ///< share of all left out together at which modes join
  double drop = 2e-3;    ///< share below which it may leave, < recall
  /// Shortest time below before it leaves, and from one change to a leaving; how far is looked ahead before
  /// modes join [s]
  double residence = 0.05;
};

/// How modes join and leave during a run.
struct AdaptivityOptions {
  const Model* full = nullptr;  ///< with every mode that is available; has to outlive the run
  /// Of `full` about the start, where it is known; needed until the run has begun.
  const LinearisedSystem* linearised = nullptr;
  std::vector<bool> active;  ///< at the start, for each coordinate of `full`
  std::vector<int> points;   ///< markers whose motion is asked for
  bool changes = true;       ///< false: modes stay as they are, the indicator alone is followed
  AdaptivityThresholds thresholds;
};

/// The largest share that a mode left out has had in a run.
struct WorstNeglect {
  ModeShare share;
  int coordinate = -1;  ///< of the full model, −1: none was left out
  double time = 0.0;    ///< [s]
};

/// Decides which modes are active: those left out join when the indicator passes the recall threshold, active
/// ones may leave when what they do stays below the drop threshold (adaptivity, eq. 3).
class ModeAdaptation {
 public:
  /// @param start  in coordinates of `options.full`; what is not active is held at its values
  ModeAdaptation(const AdaptivityOptions& options, const State& start);

  const AdaptivityOptions& options() const { return options_; }
  const ModeIndicator& indicator() const { return indicator_; }
  const std::vector<bool>& active() const { return active_; }  ///< for each coordinate of the full model
  int num_active_modes() const;

  /// Goes on to the next instant, as ModeIndicator::update.
  void update(double time, const ConstrainedEquations& run, const Eigen::VectorXd& q,
              const Eigen::VectorXd& v, const Eigen::VectorXd& v_dot);

  /// Whether a mode left out has passed the recall threshold, by the last update.
  bool misses_any() const;
  using LeftOut = std::vector<ModeIndicator::LeftOut>;  ///< by mode
  /// Raises what was largest to what there was at the last update.
  void raise(LeftOut& largest) const;
  /// Modal coordinates that have to join for that.
  std::vector<int> find_missed(const LeftOut& largest) const;
  /// Modal coordinates that may leave, once their rate is zero.
  std::vector<int> find_idle() const;
  /// Of idle ones those that can be stopped at once where they are, leaving no more ringing than modes that
  /// join may.
  /// @param v  in coordinates of the full model
  std::vector<int> find_stoppable(const std::vector<int>& idle, const Eigen::VectorXd& v) const;
  ModeShare share_of(int coordinate, const LeftOut& largest) const;

  double frequency_of(int coordinate) const;   ///< [Hz], everything else giving way
  double held_force_of(int coordinate) const;  ///< what has held it until now, without what has just jumped
  void activate(const std::vector<int>& coordinates);
  /// How long what held modes, which are active now, takes to be let go: it leaves no more than a small part
  /// of the recall threshold ringing, and ends before they may leave [s].
  double calc_release_time(const std::vector<int>& coordinates, const std::vector<double>& forces) const;
  void deactivate(const std::vector<int>& coordinates);

  /// What an active mode has done since it was not quiet last.
  struct Window {
    double since = 0.0;  ///< [s]
    double low = 0.0, high = 0.0, largest_acceleration = 0.0;
    double share = 0.0;  ///< of range and acceleration
  };
  /// The largest that a mode has done while it was left out, and when.
  struct Extreme {
    ModeIndicator::Reached reached;
    double deflection_time = 0.0;
    std::vector<double> acceleration_time;  ///< of each asked point
  };
  /// What has to be kept to take a step back to the last update.
  struct Memory {
    ModeIndicator::Memory indicator;
    std::vector<std::optional<Window>> windows;
  };
  void remember(Memory& memory) const;
  void go_back(const Memory& memory);
  /// Takes down what was largest in a step that is final. @param time  its end [s]
  void note(double time, const LeftOut& largest);
  /// Of what was noted, as shares of what was largest in all of the run: with modes that join and leave never
  /// more than the recall threshold, as steps in which it was passed have been taken back.
  WorstNeglect worst() const;

 private:
  std::size_t mode_of(int coordinate) const;

  AdaptivityOptions options_;
  ModeIndicator indicator_;
  std::vector<bool> active_;
  std::vector<std::optional<Window>> windows_;  // by mode
  double last_change_;
  std::vector<Extreme> extremes_;   // by mode
  ModeIndicator::Reached reached_;  // of one mode
};

}  // namespace sprung::dynamics
