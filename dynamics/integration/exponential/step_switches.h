#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "dynamics/integration/exponential/collocation_step.h"
#include "dynamics/integration/exponential/pair_coordinates.h"
#include "dynamics/integration/ode_system.h"
#include "dynamics/integration/switch_search.h"

namespace sprung::dynamics {

/// The switch functions along one collocation step, by their values at its nodes: whether one becomes
/// negative in the step, where, and whether one may be negative only between the nodes
/// (integration/exponential, "Hidden switches").
class StepSwitches {
 public:
  /// The motion of a step at its nodes; the first is the step's own start and not used.
  using Stages = std::array<PairedMotion, lobatto::kNumNodes>;

  /// @param system  has to outlive this   @param motion  any, for its sizes
  StepSwitches(OdeSystem& system, const PairedMotion& motion);

  bool is_empty() const { return values_.rows() == 0; }
  /// The values at a node. @return false where they cannot be found
  bool evaluate(double time, std::span<const double> y, int node);
  /// The values at a node become those at the start of a step. A switch function that has just changed its
  /// branch may be negative by a rounding error: it counts as zero, so that its next zero is not missed.
  void start_from(int node) { values_.col(0) = values_.col(node).cwiseMax(0.0); }
  /// Has to be called when the pairs have changed.
  void forget_propagators() { probe_length_ = 0.0; }

  /// Whether a switch function becomes negative from one node to a later one.
  bool crosses() const;
  /// Whether a switch function may become negative and positive again between nodes: any number of periods of
  /// a vibration may fit between them.
  bool may_hide(const CollocationStep& step, const Stages& stages, const PairCoordinates& coordinates);
  /// The place θ of the first zero, after `crosses`.
  /// @param tolerance  of the time [s]   @param[out] motion  at θ
  double locate(const CollocationStep& step, const PairCoordinates& coordinates, double tolerance,
                PairedMotion& motion);

 private:
  // Places between the nodes, at different distances from the middle: no vibration agrees with a cubic at
  // both.
  static constexpr std::array<double, 2> kProbes = {0.2, 0.6};

  void move_to_probe(const CollocationStep& step, const PairCoordinates& coordinates, std::size_t probe);
  bool evaluate_at(double time, Eigen::VectorXd& values);

  OdeSystem& system_;
  Eigen::MatrixXd values_;  // num_switches × 4
  SwitchSearch search_;
  std::array<LobattoPropagator, kProbes.size()> probe_propagators_;
  std::array<lobatto::NodeWeights, kProbes.size()> probe_weights_;
  double probe_length_ = 0.0;  // of the step that probe_propagators_ are for [s]
  LobattoPropagator propagator_;
  PairedMotion motion_;      // between nodes
  Eigen::VectorXd y_;        // there
  Eigen::VectorXd between_;  // num_switches, there
};

}  // namespace sprung::dynamics
