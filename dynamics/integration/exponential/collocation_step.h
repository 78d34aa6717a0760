#pragma once

#include <Eigen/Core>

#include "dynamics/integration/exponential/lobatto_step.h"

namespace sprung::dynamics {

/// Motion at one instant, taken apart by a VibrationBasis; or its derivative.
struct PairedMotion {
  Eigen::VectorXd u;  ///< pairs, 2f
  Eigen::VectorXd w;  ///< quadratures
};

/// What the pairs leave of the derivatives, at the Lobatto points of a step.
struct Drive {
  lobatto::NodeValues pairs;  ///< 2f×4
  lobatto::NodeValues rates;  ///< of the quadratures, a column for each point

  void set(int node, const PairedMotion& value) { pairs.col(node) = value.u, rates.col(node) = value.w; }
};

/// A step of exponential collocation: its start and its drive tell all of it.
struct CollocationStep {
  CollocationStep() = default;
  CollocationStep(Eigen::Index num_pairs, Eigen::Index num_quadratures);

  /// Motion up to the instant of a propagator, from the cubic drive.
  void propagate(const LobattoPropagator& propagator, const PairBlocks& blocks, PairedMotion& motion) const;
  /// Adds what the part of fourth degree does up to that instant, where it is known.
  void add_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks, PairedMotion& motion) const;
  /// The drive at θ.
  void calc_drive(double theta, PairedMotion& drive) const;
  /// What the part of fourth degree alone does up to that instant.
  void propagate_quartic(const LobattoPropagator& propagator, const PairBlocks& blocks,
                         PairedMotion& motion) const;

  double start = 0.0, length = 0.0;  ///< [s]
  PairedMotion motion;               ///< at the start
  Drive drive;
  PairedMotion quartic;      ///< coefficients of node_polynomial, estimated
  bool has_quartic = false;  ///< from a point of the step before; else it is no more than a guess of its size
};

/// What a step can be predicted from.
enum class Past {
  kNone,
  kSwitched,  ///< the last step was cut off where this one starts
  kSmooth,    ///< the last step ended where this one starts
};

/// Foretells the drive of a step, for the first sweep of its iteration (integration/exponential, eq. 6).
class DrivePrediction {
 public:
  DrivePrediction() = default;
  DrivePrediction(Eigen::Index num_pairs, Eigen::Index num_quadratures);

  /// Fills the drive at all points but the first: the polynomial of the last step goes on; behind a switch,
  /// beside itself through the drive that holds there.
  void predict(const CollocationStep& last, Past past, CollocationStep& now);
  /// From the drive that was found at a point: what it differs in from the expected one goes on, in the shape
  /// that the error of the prediction has, at the points behind it.
  void learn(int node, CollocationStep& now);

 private:
  Drive expected_;
  PairedMotion surprise_, at_;
  Eigen::Matrix<double, lobatto::kNumNodes, lobatto::kNumNodes>
      weights_;  // at a point (row) from another (column)
};

}  // namespace sprung::dynamics
